// A quarter of a ring, 0.1 m <= r <= 0.2 m, cells of 1/4 of its thickness.
a = 0.1; // [m]
b = 0.2; // [m]
size = (b - a) / 4;

Point(1) = {0, 0, 0};
Point(2) = {a, 0, 0, size};
Point(3) = {b, 0, 0, size};
Point(4) = {0, b, 0, size};
Point(5) = {0, a, 0, size};

Line(1) = {2, 3};
Circle(2) = {3, 1, 4};
Line(3) = {4, 5};
Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};

Physical Curve("level") = {1};
Physical Curve("outer") = {2};
Physical Curve("upright") = {3};
Physical Curve("inner") = {4};
Physical Surface("ring") = {1};
