//! Short runs in which contact codes commonly fail: each says why, and what passing means.
//!
//! The scenes are in `data/scenes/hard`.

mod beyond;
mod bounded;
mod checkpoint;
mod collapse;
mod cycles;
mod elsewhere;
mod flow;
mod foreign_meshes;
mod held_by_contact;
mod incompressible;
mod killed;
mod loose_sideways;
mod numbers;
mod outgrown;
mod peers;
mod prescribed;
mod quality;
mod receding;
mod refinement;
mod rounded_places;
mod selftest;
mod solids;
mod taken_off;
mod touching;
mod whether_it_yields;
mod whole_rollers;
