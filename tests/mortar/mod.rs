//! Surfaces whose nodes do not face each other.

mod blocks;
mod conforming;
mod edges;
mod hertz;
mod hertz_in_space;
mod patch;
mod published;
mod sheet;
mod soft;
mod tie;
mod tied_bodies;
