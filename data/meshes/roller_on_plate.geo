// A quarter of a roller on half a plate, triangles of six nodes, each body meshed for itself:
// gmsh -2 -order 2 roller_on_plate.geo -o roller_on_plate.msh
R = 10;
near = 4 * Pi / 180;     // as far elements are small
far = 12 * Pi / 180;     // as far the bodies may touch
h = 0.07;
Point(1) = {0, 0, 0, h};
Point(2) = {0, R, 0, 2.2};
Point(3) = {R, R, 0, 2.2};
Point(4) = {R * Sin(near), R - R * Cos(near), 0, h};
Point(5) = {R * Sin(far), R - R * Cos(far), 0, 0.5};
Point(6) = {0, 0.7, 0, 0.1};
Circle(1) = {1, 2, 4};
Circle(2) = {4, 2, 5};
Circle(3) = {5, 2, 3};
Line(4) = {3, 2};
Line(5) = {2, 6};
Line(6) = {6, 1};
Curve Loop(1) = {1, 2, 3, 4, 5, 6};
Plane Surface(1) = {1};

k = 0.055;
Point(11) = {0, 0, 0, k};
Point(12) = {0, -0.7, 0, 0.1};
Point(13) = {0, -R, 0, 2.2};
Point(14) = {R, -R, 0, 2.2};
Point(15) = {R, 0, 0, 2.2};
Point(16) = {2, 0, 0, 0.45};
Point(17) = {0.7, 0, 0, k};
Line(11) = {11, 12};
Line(12) = {12, 13};
Line(13) = {13, 14};
Line(14) = {14, 15};
Line(15) = {15, 16};
Line(16) = {16, 17};
Line(17) = {17, 11};
Curve Loop(2) = {11, 12, 13, 14, 15, 16, 17};
Plane Surface(2) = {2};

Physical Curve("roller.contact") = {1, 2};
Physical Curve("roller.top") = {4};
Physical Curve("roller.symmetry") = {5, 6};
Physical Curve("plate.contact") = {16, 17};
Physical Curve("plate.bottom") = {13};
Physical Curve("plate.symmetry") = {11, 12};
Physical Surface("roller") = {1};
Physical Surface("plate") = {2};
