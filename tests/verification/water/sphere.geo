// A quarter of a sphere's section, radius 1 m, axis x = 0.
n = 8; // cells along the radius
size = 1.0 / n;

Point(1) = {0, 0, 0, size};
Point(2) = {1, 0, 0, size};
Point(3) = {0, 1, 0, size};

Line(1) = {1, 2};
Circle(2) = {2, 1, 3};
Line(3) = {3, 1};
Curve Loop(1) = {1, 2, 3};
Plane Surface(1) = {1};

Physical Curve("level") = {1};
Physical Curve("surface") = {2};
Physical Curve("axis") = {3};
Physical Surface("ball") = {1};
