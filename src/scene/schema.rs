//! The JSON schema of scenes, generated from the types that read them.

use super::Scene;
use serde_json::Value;

/// The JSON schema (draft 2020-12) of a scene file: keys, types, defaults and their meaning.
/// Editors that support schemas for TOML use it to complete and check scenes. Conditions that a
/// schema cannot express (references between names, exactly one of several keys) are checked when
/// the scene is read.
pub fn schema() -> Value {
    let mut schema = schemars::schema_for!(Scene).to_value();
    if let Value::Object(keys) = &mut schema {
        keys.insert("title".into(), "Scene of brinell".into());
    }
    schema
}
