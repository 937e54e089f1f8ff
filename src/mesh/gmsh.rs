//! Gmsh.
