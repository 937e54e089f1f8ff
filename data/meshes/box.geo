// A quarter of a box with a pad in the middle of its top, hexahedra of eight nodes:
// gmsh -3 box.geo -o box.msh
c = 0.18;                // half the pad
n = 7;                   // elements over it
m = 4;                   // and beside it
Point(1) = {0, 0, 1};
Point(2) = {c, 0, 1};
Point(3) = {0.5, 0, 1};
Line(1) = {1, 2};
Line(2) = {2, 3};
Transfinite Curve {1} = n + 1;
Transfinite Curve {2} = m + 1 Using Progression 1.45;
left[] = Extrude {0, c, 0} { Curve{1, 2}; Layers{n}; Recombine; };
// Elements beside the pad grow along y as they do along x.
h[] = {};
For k In {1:m}
  h[k - 1] = (1.45^k - 1) / (1.45^m - 1);
EndFor
ones[] = {};
For k In {1:m}
  ones[k - 1] = 1;
EndFor
right[] = Extrude {0, 0.5 - c, 0} { Curve{left[0], left[4]}; Layers{ones[], h[]}; Recombine; };
d[] = {};
few[] = {};
For k In {1:10}
  d[k - 1] = (1.3^k - 1) / (1.3^10 - 1);
  few[k - 1] = 1;
EndFor
box[] = Extrude {0, 0, -1} { Surface{left[1], left[5], right[1], right[5]}; Layers{few[], d[]}; Recombine; };
e = 1e-6;
Physical Volume("box") = {Volume{:}};
Physical Surface("box.pad") = {left[1]};
Physical Surface("box.bottom") = {Surface In BoundingBox{-e, -e, -e, 1, 1, e}};
Physical Surface("box.left") = {Surface In BoundingBox{-e, -e, -e, e, 1, 1 + e}};
Physical Surface("box.front") = {Surface In BoundingBox{-e, -e, -e, 1, e, 1 + e}};
Physical Surface("box.right") = {Surface In BoundingBox{0.5 - e, -e, -e, 0.5 + e, 1, 1 + e}};
Physical Surface("box.back") = {Surface In BoundingBox{-e, 0.5 - e, -e, 1, 0.5 + e, 1 + e}};
