// Two blocks for data/scenes/blocks_tet10.toml: gmsh -3 blocks_tet10.geo
// A quarter of both; the punch stands on a patch of the block that has the same mesh.
SetFactory("OpenCASCADE");
Box(1) = {0, 0, -2, 2, 2, 2};      // block
Rectangle(100) = {0, 0, 0, 1, 1};  // the patch that the punch stands on
BooleanFragments{ Volume{1}; Delete; }{ Surface{100}; Delete; }
Box(2) = {0, 0, 0, 1, 1, 1};       // punch

e = 1e-6;
block() = Volume In BoundingBox {-e, -e, -2-e, 2+e, 2+e, e};
punch() = Volume In BoundingBox {-e, -e, -e, 1+e, 1+e, 1+e};
patch() = Surface In BoundingBox {-e, -e, -e, 1+e, 1+e, e};
Physical Volume("block") = {block()};
Physical Volume("punch") = {punch()};
b() = Boundary{ Volume{block()}; };
p() = Boundary{ Volume{punch()}; };
For i In {0 : #patch()-1}
  own = 0;
  For j In {0 : #b()-1}
    If (b(j) == patch(i))
      own = 1;
    EndIf
  EndFor
  If (own)
    top = patch(i);
  Else
    foot = patch(i);
  EndIf
EndFor
Periodic Surface {foot} = {top} Translate {0, 0, 0};
Physical Surface("block.contact") = {top};
Physical Surface("punch.contact") = {foot};
Physical Surface("punch.top") = Surface In BoundingBox {-e, -e, 1-e, 1+e, 1+e, 1+e};
Physical Surface("block.bottom") = Surface In BoundingBox {-e, -e, -2-e, 2+e, 2+e, -2+e};
Physical Surface("block.x0") = Surface In BoundingBox {-e, -e, -2-e, e, 2+e, e};
Physical Surface("block.y0") = Surface In BoundingBox {-e, -e, -2-e, 2+e, e, e};
Physical Surface("punch.x0") = Surface In BoundingBox {-e, -e, -e, e, 1+e, 1+e};
Physical Surface("punch.y0") = Surface In BoundingBox {-e, -e, -e, 1+e, e, 1+e};

MeshSize { PointsOf{ Volume{block()}; } } = 0.7;
MeshSize { PointsOf{ Surface{top}; } } = 0.3;
MeshSize { PointsOf{ Volume{punch()}; } } = 0.3;
Mesh.ElementOrder = 2;
Mesh.MshFileVersion = 4.1;
