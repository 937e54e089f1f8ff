// A punch with a rounded edge on a foundation, half of the section, triangles of six nodes:
// gmsh -2 -order 2 punch.geo -o punch.msh
h = 0.4;
Point(1) = {0, 0, 0, 4};
Point(2) = {38, 0, 0, h};
Point(3) = {40, 0, 0, h};
Point(4) = {40 + 10 * Sin(Pi / 15), 10 - 10 * Cos(Pi / 15), 0, h};
Point(5) = {50, 10, 0, 3};
Point(6) = {50, 100, 0, 20};
Point(7) = {0, 100, 0, 20};
Point(8) = {40, 10, 0, 1};
Line(1) = {1, 2};
Line(2) = {2, 3};
Circle(3) = {3, 8, 4};
Circle(4) = {4, 8, 5};
Line(5) = {5, 6};
Line(6) = {6, 7};
Line(7) = {7, 1};
Curve Loop(1) = {1 ... 7};
Plane Surface(1) = {1};

Point(11) = {0, 0, 0, 4};
Point(12) = {38, 0, 0, h};
Point(13) = {43, 0, 0, h};
Point(14) = {100, 0, 0, 20};
Point(15) = {100, -200, 0, 40};
Point(16) = {0, -200, 0, 40};
Line(11) = {11, 12};
Line(12) = {12, 13};
Line(13) = {13, 14};
Line(14) = {14, 15};
Line(15) = {15, 16};
Line(16) = {16, 11};
Curve Loop(2) = {11 ... 16};
Plane Surface(2) = {2};

Physical Curve("punch.flat") = {1, 2};
Physical Curve("punch.fillet") = {3, 4};
Physical Curve("punch.contact") = {1, 2, 3, 4};
Physical Curve("punch.top") = {6};
Physical Curve("punch.axis") = {7};
Physical Curve("foundation.contact") = {11, 12, 13};
Physical Curve("foundation.bottom") = {15};
Physical Curve("foundation.side") = {14};
Physical Curve("foundation.axis") = {16};
Physical Surface("punch") = {1};
Physical Surface("foundation") = {2};
