// A quarter of the section of a ball with a cavity, 1 m <= r <= 3000 m, cells
// of a tenth of their radius (times `share`).
a = 1;      // [m]
b = 3000;   // [m]
share = 0.12;

Point(1) = {0, 0, 0};
Point(2) = {a, 0, 0, share * a};
Point(3) = {b, 0, 0, share * b};
Point(4) = {0, b, 0, share * b};
Point(5) = {0, a, 0, share * a};

Line(1) = {2, 3};
Circle(2) = {3, 1, 4};
Line(3) = {4, 5};
Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};

Physical Curve("level") = {1};
Physical Curve("outer") = {2};
Physical Curve("upright") = {3};
Physical Curve("cavity") = {4};
Physical Surface("ground") = {1};
