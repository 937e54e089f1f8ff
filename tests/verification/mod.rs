//! Published cases with known answers, run through the library: one case per file, its source at
//! the head.

mod back_stresses;
mod body_forces;
mod by_position;
mod by_position_refused;
mod circular_punch;
mod contact_edges;
mod contact_patch;
mod cycles;
mod cyclic_element;
mod disc_in_plate;
mod driving_force;
mod equations;
mod figures;
mod flat_punch;
mod followed;
mod gap_load;
mod heat;
mod hertz_line;
mod hertz_line_history;
mod hertz_point;
mod initial_state;
mod nafems_cb1;
mod over_temperature;
mod pin_in_hole;
mod planes_of_symmetry;
mod quality;
mod run;
mod shakedown;
mod shrink_fit;
mod ssnv104;
mod start_from;
mod thick_cylinder;
mod thick_sphere;
mod yield_depth;
mod yield_load;
