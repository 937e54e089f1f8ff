//! Two bodies that are meshed by themselves and pressed on each other, from a file.

use super::support;
use super::support::msh::{Body, Msh};
use super::support::random::Random;
use brinell::scene::Scene;
use std::path::Path;

/// The upper body, of steel, and the lower one that yields.
pub struct PressedFile<'a> {
    pub title: &'static str,
    pub names: [&'static str; 2],
    pub width: f64,
    /// Underside of the upper body over x; its top and the bottom of the lower one lie this far
    /// from zero.
    pub underside: &'a dyn Fn(f64) -> f64,
    pub height: f64,
    pub grading: f64,
    /// Share of a cell by which places are moved, and the seed of that.
    pub jitter: f64,
    pub seed: u64,
    /// Keys in front of the mesh, the material of the lower body, the load on the upper one, and
    /// the program.
    pub head: &'static str,
    pub lower: &'static str,
    pub load: &'static str,
    pub program: &'static str,
}

impl PressedFile<'_> {
    /// The scene on triangles or quadrangles of an order, `n` cells high.
    pub fn scene(&self, folder: &Path, (triangles, order): (bool, usize), n: usize) -> Scene {
        let mut msh = Msh::default();
        let random = &mut Random::new(self.seed);
        let (top, bottom) = (|_| self.height, |_| -self.height);
        let body = |name, heights| Body {
            name,
            from: 0.0,
            width: self.width,
            cells: [2 * n, n],
            heights,
            kink: None,
            grading: self.grading,
            jitter: self.jitter,
        };
        let [upper, lower] = self.names;
        body(upper, [self.underside, &top]).plane(&mut msh, triangles, order, random);
        body(lower, [&bottom, &|_| 0.0]).plane(&mut msh, triangles, order, random);
        let name = format!("{upper}-{triangles}-{order}-{n}-{}.msh", self.jitter);
        let file = folder.join(name);
        std::fs::write(&file, msh.text()).unwrap();
        support::parse(&format!(
            r#"
title = "{}"
kind = "plane_strain"
{}
mesh.file = {file:?}
[materials.steel]
youngs_modulus = 210e3
poissons_ratio = 0.3
[materials.lower]
{}
[bodies]
{upper} = {{ material = "steel" }}
{lower} = {{ material = "lower" }}
[[contact]]
first = "{upper} bottom"
second = "{lower} top"
[[support]]
on = "{upper} axis"
fix = ["x"]
[[support]]
on = "{lower} axis"
fix = ["x"]
[[support]]
on = "{lower} bottom"
fix = ["y"]
[[load]]
on = "{upper} top"
{}
[program]
{}
"#,
            self.title, self.head, self.lower, self.load, self.program
        ))
    }
}
