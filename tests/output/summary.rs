//! `summary.json` and its schema.

use crate::output::fixture;
use brinell::output::{RunHeader, SUMMARY_SCHEMA, summary, write};
use brinell::results::{QUANTITIES, Quantity, Results, State};
use serde_json::{Value, json};

fn schema() -> jsonschema::Validator {
    let schema: Value = serde_json::from_str(SUMMARY_SCHEMA).unwrap();
    jsonschema::draft202012::meta::validate(&schema).unwrap();
    jsonschema::draft202012::new(&schema).unwrap()
}

#[track_caller]
fn assert_valid(instance: &Value) {
    let errors: Vec<String> = schema()
        .iter_errors(instance)
        .map(|e| format!("{}: {e}", e.instance_path()))
        .collect();
    assert!(errors.is_empty(), "{errors:#?}\n{instance:#}");
}

fn minimal_header() -> RunHeader {
    RunHeader {
        kind: "plane_stress".into(),
        ..RunHeader::default()
    }
}

#[test]
fn a_full_summary_obeys_the_schema_and_has_every_value() {
    let mesh = fixture::mesh();
    let mut value = summary(&fixture::header(), &fixture::results_of_ranks(&mesh, 2));
    assert_valid(&value);

    let peak = value["peak_memory_bytes"].take();
    if cfg!(target_os = "linux") {
        // This process holds its own code at least, and no more than the machine can address.
        assert!((1 << 16..1 << 46).contains(&peak.as_u64().unwrap()));
    } else {
        assert_eq!(peak, Value::Null);
    }
    let quality = json!({
        "backward_error": 1e-16, "componentwise_error": 2e-16, "round_off": 3e-14,
        "equilibrium": 2e-12, "complementarity": 0.0,
        "penetration": 3e-17, "adhesion": 4e-17
    });
    let pressed = json!({
        "name": "b = 1.5 b*", "alpha": 2.0635, "load": 123.456, "contact_force": 123.4,
        "closed_pairs": 1, "max_pressure": 300.0, "pole_pressure": 299.0, "half_width": 1.5,
        "contact_arc": {"from": -19.625, "to": 19.625}, "contact_area": 3.0, "residual_depth": 0.01,
        "residual_depth_by_body": {"cylinder": 0.006, "half_plane": 0.004}, "rim_height": 0.001,
        "approach": 0.3,
        "plastic_points": 7, "plastic_points_by_body": {"cylinder": 3, "half_plane": 4},
        "max_equivalent_plastic_strain": 0.02, "plastic_zone_size": 0.004, "plastic_work": 0.7,
        "plastic_depth": 0.0123, "energy_error": 0.05,
        "quality": quality,
        "fields": "state_01_b___1.5_b_.pvtu"
    });
    let mut between = pressed.clone();
    between["name"] = "between".into();
    between["contact_arc"] = Value::Null;
    between["fields"] = Value::Null;
    let mut released = pressed.clone();
    released["name"] = "released".into();
    released["fields"] = "state_03_released.pvtu".into();
    let by_rank = [65536.5, 4096.5];
    let ranks = json!({
        "count": 2, "requests": 15, "bytes": 4096, "peak_memory_bytes": [1048576, null]
    });
    let effects = json!({
        "contact": {"on": true, "why": "2 pairs may touch", "seconds": 0.5, "memory_bytes": 4096}
    });
    let accuracy = json!({
        "method": "coarser_meshes",
        "companions": [{"ratio": 2.0, "freedoms": 9, "seconds": 0.25}],
        "quantities": [{
            "quantity": "yield.load", "value": 60.0, "error": 0.5, "relative_error": 0.005,
            "discretisation": 0.4, "path": 0.09, "algebraic": 0.01, "order": null,
            "extrapolated": 60.2
        }],
        "demand": {
            "accuracy": 0.01, "demanded": "1 %", "reached": false, "reason": "time",
            "unknown": ["states.s.load"],
            "stated": 0.005, "worst": "yield.load", "choices": ["resolution 16"], "work": 3e9
        },
        "seconds": 0.5, "work": 1e9,
        "notes": ["a mesh failed"]
    });
    let expected = json!({
        "brinell": env!("CARGO_PKG_VERSION"),
        "scene": "cylinder \"on\" <plane> & more",
        "scene_file": "scenes/cylinder.toml",
        "kind": "plane_strain",
        "units": null,
        "half_width_is": "half_width",
        "solver": "dense",
        "kernels": null,
        "nodes": 15, "elements": 4, "freedoms": 27, "contact_pairs": 2,
        "zone_freedoms": 9, "zone_elements": 2,
        "effects": effects,
        "timings": {"assembly": 0.375, "factorisation": 0.5, "total": 1.25},
        "peak_memory_bytes": null,
        "ranks": ranks,
        "counts": {
            "factorizations": 1, "zone_factorizations": 2, "trailing_solves": 40,
            "full_solves": 3,
            "plastic_iterations": 12, "contact_changes": 2,
            "hard_increments": 1
        },
        "factor": {
            "ordering": "CAMD", "factor_nonzeros": 1234, "trailing_nonzeros": 99,
            "flops": 5e20, "memory_bytes": 65536, "memory_by_rank": by_rank
        },
        "condition": 1e4,
        "condition_estimate": 3e4,
        "quality": quality,
        "inaccurate": ["state `released` is inaccurate"],
        "yield": {
            "alpha": 1.0, "load": 60.0, "max_pressure": 179.37, "half_width": 1.0,
            "location": {"x": 0.0, "y": -0.7, "body": "half_plane"}
        },
        "states": [pressed, between, released],
        "cycles": {
            "outcome": "ratchetting", "body": "block",
            "rows": [{"cycle": 1, "flow": 2e-3, "growth": 1e-3}]
        },
        "reference": [{
            "quantity": "yield.load", "reference": 61.0, "computed": 60.0, "ratio": 60.0 / 61.0,
            "published_ratio": null, "source": "Johnson, Contact Mechanics, p. 155"
        }],
        "accuracy": accuracy,
        "warnings": ["tri3 elements lock where they yield"],
        "resumed": 2,
        "incomplete": "stopped on request"
    });
    assert_eq!(value, expected);
    // In this order, too.
    let [written, wanted] = [&value, &expected].map(|v| serde_json::to_string_pretty(v).unwrap());
    assert_eq!(written, wanted);
}

#[test]
fn a_minimal_summary_obeys_the_schema() {
    let value = summary(&minimal_header(), &Results::default());
    assert_valid(&value);
    assert_eq!(value["yield"], Value::Null);
    assert_eq!(value["incomplete"], Value::Null);
    assert_eq!(value["scene_file"], Value::Null);
    assert_eq!(value["states"], json!([]));
    assert_eq!(value["timings"], json!({"total": 0.0}));
}

#[test]
fn numbers_that_are_not_finite_are_null() {
    let mut results = Results {
        states: vec![State {
            max_pressure: f64::NAN,
            half_width: f64::INFINITY,
            contact_arc: Some([f64::NEG_INFINITY, 1.0]),
            ..State::default()
        }],
        ..Results::default()
    };
    results.quality.equilibrium = f64::NAN;
    results.factor.flops = f64::INFINITY;
    results.timings = vec![("assembly".into(), f64::NAN)];
    let value = summary(&minimal_header(), &results);
    assert_valid(&value);
    assert_eq!(value["states"][0]["max_pressure"], Value::Null);
    assert_eq!(value["states"][0]["half_width"], Value::Null);
    let arc = &value["states"][0]["contact_arc"];
    assert_eq!(arc, &json!({"from": null, "to": 1.0}));
    assert_eq!(value["quality"]["equilibrium"], Value::Null);
    assert_eq!(value["factor"]["flops"], Value::Null);
    assert_eq!(value["timings"]["assembly"], Value::Null);
}

/// Every quantity of the table stands in the schema of a state (of first yield, where it is known
/// there), required and described, and nothing else that is a number does.
#[test]
fn the_schema_has_the_quantities_of_the_table() {
    let schema: Value = serde_json::from_str(SUMMARY_SCHEMA).unwrap();
    let first_yield = &schema["properties"]["yield"]["oneOf"][1];
    let state = &schema["$defs"]["state"];
    for (part, keys) in [
        (state, QUANTITIES.iter().map(|q| q.key).collect::<Vec<_>>()),
        (
            first_yield,
            QUANTITIES
                .iter()
                .filter(|q| q.at_yield.is_some())
                .map(|q| q.key)
                .collect(),
        ),
    ] {
        let numbers = part["properties"].as_object().unwrap().iter();
        let numbers: Vec<&String> = numbers
            .filter(|(_, entry)| {
                let kind = entry["$ref"].as_str().unwrap_or_default();
                ["figure", "magnitude", "count"]
                    .iter()
                    .any(|k| kind.ends_with(k))
            })
            .map(|(key, _)| key)
            .collect();
        assert_eq!(numbers, keys);
        let required = part["required"].as_array().unwrap();
        for key in keys {
            assert!(required.contains(&key.into()), "{key}");
            assert!(part["properties"][key]["description"].is_string(), "{key}");
        }
    }
    for quantity in &QUANTITIES {
        let count = state["properties"][quantity.key]["$ref"] == "#/$defs/count";
        assert_eq!(count, quantity.is_count, "{}", quantity.key);
        // Twins, keys and short names are those of the table.
        assert!(
            quantity
                .twin
                .is_none_or(|twin| Quantity::of(twin).is_some())
        );
        assert!(std::ptr::eq(Quantity::of(quantity.key).unwrap(), quantity));
    }
}

/// The schema has to refuse what is wrong: each required key taken away, each key misspelt, wrong
/// types.
#[test]
fn the_schema_refuses_missing_and_unknown_keys() {
    let mesh = fixture::mesh();
    let valid = summary(&fixture::header(), &fixture::results_of_ranks(&mesh, 2));
    let schema = schema();
    let mut objects = Vec::new();
    paths_of_objects(&valid, String::new(), &mut objects);
    // Open objects, keyed by what the scene calls things.
    let open = [
        "/effects",
        "/timings",
        "/plastic_points_by_body",
        "/residual_depth_by_body",
    ];
    objects.retain(|path| !open.iter().any(|end| path.ends_with(end)));
    // The root, an effect, ranks, counts, factor, quality, yield with its location, three states
    // with quality (two with an arc), cycles with one, a reference, accuracy with a mesh, a
    // quantity and a demand.
    assert_eq!(
        objects.len(),
        1 + 1 + 1 + 1 + 1 + 1 + 2 + 3 + 3 + 2 + 2 + 1 + 4
    );
    for path in objects {
        let object = valid.pointer(&path).unwrap().as_object().unwrap();
        for key in object.keys() {
            let mut damaged = valid.clone();
            let target = damaged.pointer_mut(&path).unwrap();
            target.as_object_mut().unwrap().remove(key);
            assert!(!schema.is_valid(&damaged), "{path}/{key} is not required");
        }
        let mut damaged = valid.clone();
        damaged.pointer_mut(&path).unwrap()["misspelt"] = 1.into();
        assert!(!schema.is_valid(&damaged), "{path} takes any key");
    }
    for (path, wrong) in [
        ("/kind", json!("plane")),
        ("/freedoms", json!(-1)),
        ("/freedoms", json!(1.5)),
        ("/yield/load", json!("60")),
        ("/states/0/fields", json!("../up.vtu")),
        ("/quality/equilibrium", json!(-1.0)),
        ("/accuracy/method", json!("guess")),
        ("/accuracy/quantities/0/error", json!(-0.5)),
        ("/timings/total", json!(-1.0)),
    ] {
        let mut damaged = valid.clone();
        *damaged.pointer_mut(path).unwrap() = wrong;
        assert!(!schema.is_valid(&damaged), "{path}");
    }
}

fn paths_of_objects(value: &Value, path: String, found: &mut Vec<String>) {
    match value {
        Value::Object(map) => {
            for (key, child) in map {
                paths_of_objects(child, format!("{path}/{key}"), found);
            }
            found.push(path);
        }
        Value::Array(items) => {
            for (i, child) in items.iter().enumerate() {
                paths_of_objects(child, format!("{path}/{i}"), found);
            }
        }
        _ => {}
    }
}

#[test]
fn the_file_holds_the_summary_and_names_files_that_exist() {
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("run.out");
    let mesh = fixture::mesh();
    let results = fixture::results(&mesh);
    write(&dir, &fixture::header(), &mesh, &results).unwrap();
    let text = std::fs::read_to_string(dir.join("summary.json")).unwrap();
    assert!(text.ends_with("}\n"));
    let mut read: Value = serde_json::from_str(&text).unwrap();
    assert_valid(&read);
    for state in read["states"].as_array().unwrap() {
        if let Some(file) = state["fields"].as_str() {
            assert!(dir.join(file).is_file());
        }
    }
    let mut computed = summary(&fixture::header(), &results);
    // The peak may have grown in between.
    read["peak_memory_bytes"].take();
    computed["peak_memory_bytes"].take();
    // Compared as text: reading JSON may round the last digit.
    let written = serde_json::to_string_pretty(&computed).unwrap() + "\n";
    let without_peak = |text: &str| -> Vec<String> {
        let lines = text.lines().filter(|l| !l.contains("peak_memory_bytes"));
        lines.map(str::to_owned).collect()
    };
    assert_eq!(without_peak(&text), without_peak(&written));
}
