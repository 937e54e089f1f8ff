//! The report of a run in three dimensions.

use brinell::analysis::Analysis;
use brinell::linalg::Backend;
use brinell::model::Model;
use brinell::output::{RunHeader, write_with_report};
use brinell::progress::Silent;
use brinell::scene::Scene;

/// Each state in contact has a map of its pressure, with the ellipse of its half axes; a state
/// without contact has none.
#[test]
fn states_in_contact_have_a_map_of_their_pressure() {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/data/scenes/ball_on_flat_3d.toml"
    );
    let overrides = ["mesh.curved_bodies.resolution=3".to_string()];
    let scene = Scene::load_with(path, &overrides).unwrap();
    let mut analysis = Analysis::new(Model::new(&scene).unwrap(), Backend::default()).unwrap();
    let results = analysis.run(&mut Silent).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let dir = folder.path().join("out");
    let header = RunHeader::new(analysis.model(), Backend::default(), 1.0);
    write_with_report(&dir, &header, analysis.model(), &results).unwrap();
    let read = |name: &str| std::fs::read_to_string(dir.join(name)).unwrap();
    let maps: Vec<String> = (std::fs::read_dir(&dir).unwrap())
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| name.contains("contact_pressure"))
        .collect();
    let touching = results
        .states
        .iter()
        .filter(|state| !state.patches.is_empty());
    assert_eq!(maps.len(), touching.count());
    assert!(maps.len() == 4 && results.states.len() == 5, "{maps:?}");
    for map in &maps {
        let text = read(map);
        assert!(!text.contains("NaN") && !text.contains("inf"), "{map}");
        assert!(text.contains("data:image/png;base64,"), "{map}");
        assert!(text.matches("<polyline").count() > 20, "{map}: no ellipse");
        assert!(text.contains("x in mm") || text.contains("x [mm]"), "{map}");
    }
    let page = read("report.html");
    assert!(page.contains("Contact pressure, load") && page.contains("ellipse of the half axes"));
}
