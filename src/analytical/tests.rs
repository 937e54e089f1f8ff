//! Compares every published figure of `data/reference` with the closed form that gives it.

use super::*;
use std::path::PathBuf;

/// The closed form's value of a quantity named in an `exact.csv`.
fn computed(quantity: &str) -> Option<f64> {
    let line = HertzLine::new(1.0, 1.0).unwrap();
    let point = HertzPoint::new(1.0, 1.0).unwrap();
    let disc = DiscInPlate::new(1.0).unwrap();
    let cb1 = HertzLine::new(50.0, contact_modulus(210e3, 0.3, 70e3, 0.3)).unwrap();
    let spheres = {
        let modulus = contact_modulus(20e3, 0.3, 20e3, 0.3);
        HertzPoint::new(relative_radius(50.0, 50.0), modulus).unwrap()
    };
    let cylinder = ElastoplasticCylinder::new(100.0, 200.0, 210e3, 240.0).unwrap();
    let fit = {
        let ring = ThickCylinder::new(50.0, 100.0, 210e3, 0.3, Plane::Stress).unwrap();
        ShrinkFit::new(0.05, ring, 0.0, 210e3, 0.3).unwrap()
    };
    let pin = PinInHole::new(1.0, 0.0, 1.0).unwrap();
    Some(match quantity {
        "line_yield_pressure" => HertzLine::yield_pressure(0.3, 1.0),
        "line_yield_depth" => line.yield_depth(0.3, 1.0) / line.yield_half_width(0.3, 1.0),
        "line_yield_load" => line.yield_load(0.3, 1.0),
        "line_yield_half_width" => line.yield_half_width(0.3, 1.0),
        "disc_half_angle" => disc.half_angle().to_degrees(),
        "disc_pole_pressure" => disc.pressure(0.0, 1.0),
        "disc_yield_tension_plane_stress" => disc.yield_tension(Plane::Stress, 0.3, 1.0).unwrap(),
        "disc_yield_tension_plane_strain" => disc.yield_tension(Plane::Strain, 0.3, 1.0).unwrap(),
        "point_yield_pressure" => HertzPoint::yield_pressure(0.3, 1.0),
        "point_yield_depth" => point.yield_depth(0.3, 1.0) / point.yield_contact_radius(0.3, 1.0),
        "point_yield_load" => point.yield_load(0.3, 1.0),
        "cb1_half_width" => cb1.half_width(35e3),
        "cb1_max_pressure" => cb1.max_pressure(35e3),
        "ssnv104_centre_stress" => spheres.stress(0.0, 0.0, spheres.load_for_approach(4.0), 0.3)[2],
        "ssnv104_contact_radius" => spheres.contact_radius(spheres.load_for_approach(4.0)),
        "cylinder_yield_pressure" => cylinder.yield_pressure(),
        "cylinder_collapse_pressure" => cylinder.collapse_pressure(),
        "shrink_fit_pressure" => fit.pressure(),
        "flat_punch_mean_pressure" => FlatPunch::limit_mean_pressure(1.0),
        "circular_punch_smooth" => CircularPunch::SMOOTH_LIMIT_OVER_SHEAR_YIELD,
        "circular_punch_rough" => CircularPunch::ROUGH_LIMIT_OVER_SHEAR_YIELD,
        "neat_half_angle" => PinInHole::neat_half_angle().to_degrees(),
        "neat_max_pressure" => pin.max_pressure(1.0).unwrap(),
        _ => return None,
    })
}

#[test]
fn every_published_figure_has_a_closed_form_that_gives_it() {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("data/reference");
    let mut rows = 0;
    for source in [
        "endahl",
        "hertz",
        "nafems_r0094",
        "code_aster_ssnv104",
        "hill",
        "punch",
        "persson",
    ] {
        let path = root.join(source).join("exact.csv");
        for record in csv::Reader::from_path(&path).unwrap().records() {
            let record = record.unwrap();
            let published: f64 = record[1].parse().unwrap();
            let tolerance: f64 = record[2].parse().unwrap();
            let value = computed(&record[0])
                .unwrap_or_else(|| panic!("{}: no closed form for {}", path.display(), &record[0]));
            assert!(
                (value - published).abs() <= tolerance,
                "{}: {} is {value}, published {published}",
                path.display(),
                &record[0]
            );
            rows += 1;
        }
    }
    assert_eq!(rows, 23);
}
