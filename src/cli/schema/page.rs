//! A JSON schema as a page of Markdown: a table of keys for each kind of table.

use serde_json::{Map, Value};
use std::collections::VecDeque;

type Object = Map<String, Value>;

/// Returns the page of a schema: its keys, then the keys of every definition in the order in which
/// the definitions are first named. Names of definitions become headings.
pub(super) fn page(schema: &Value, heading: &str, introduction: &str) -> String {
    let nothing = Object::new();
    let definitions = schema["$defs"].as_object().unwrap_or(&nothing);
    let mut page = Page {
        definitions,
        waiting: VecDeque::new(),
        seen: Vec::new(),
    };
    let mut text = format!("# {heading}\n\n{introduction}\n\n{}", page.keys(schema));
    while let Some(name) = page.waiting.pop_front() {
        let definition = &definitions[&name];
        text.push_str(&format!("\n## {name}\n\n{}", page.definition(definition)));
    }
    text
}

struct Page<'s> {
    definitions: &'s Object,
    /// Definitions that have been named but not yet written.
    waiting: VecDeque<String>,
    seen: Vec<String>,
}

impl Page<'_> {
    /// Describes a definition: its meaning, and its keys or values.
    fn definition(&mut self, schema: &Value) -> String {
        let about = without_links(schema["description"].as_str().unwrap_or_default());
        let mut text = match about.trim() {
            "" => String::new(),
            about => format!("{about}\n\n"),
        };
        if schema["properties"].is_object() {
            text.push_str(&self.keys(schema));
            return text;
        }
        let kinds = schema["oneOf"].as_array().map_or(&[][..], Vec::as_slice);
        for kind in kinds {
            let about = in_line(kind["description"].as_str().unwrap_or_default());
            text.push_str(&format!("- {}: {about}\n", self.kind(kind)));
        }
        if kinds.is_empty() {
            text.push_str(&format!("Type: {}\n", self.kind(schema)));
        }
        text
    }

    /// Returns the table of the keys of an object.
    fn keys(&mut self, schema: &Value) -> String {
        let nothing = Object::new();
        let keys = schema["properties"].as_object().unwrap_or(&nothing);
        let required = schema["required"].as_array().map_or(&[][..], Vec::as_slice);
        let mut text = "| key | type | default | meaning |\n|---|---|---|---|\n".to_string();
        for (key, of_key) in keys {
            let default = match &of_key["default"] {
                _ if required.iter().any(|name| name == key) => "required".to_string(),
                Value::Null => String::new(),
                Value::Array(list) if list.is_empty() => String::new(),
                Value::Object(table) if !table.is_empty() => "see there".to_string(),
                Value::Object(_) => String::new(),
                value => format!("`{value}`"),
            };
            let about = in_line(of_key["description"].as_str().unwrap_or_default());
            let kind = self.kind(of_key);
            text.push_str(&format!("| `{key}` | {kind} | {default} | {about} |\n"));
        }
        text
    }

    /// Describes a type in words.
    fn kind(&mut self, schema: &Value) -> String {
        if let Some(name) = schema["$ref"]
            .as_str()
            .and_then(|path| path.rsplit('/').next())
        {
            return self.link(name);
        }
        if let Some(value) = schema.get("const") {
            return format!("`{value}`");
        }
        if let Some(values) = schema["enum"].as_array() {
            let values = values.iter().filter(|value| !value.is_null());
            return values
                .map(|value| format!("`{value}`"))
                .collect::<Vec<_>>()
                .join(" or ");
        }
        for key in ["anyOf", "oneOf", "allOf"] {
            if let Some(kinds) = schema[key].as_array() {
                let kinds = kinds.iter().filter(|kind| kind["type"] != "null");
                return kinds
                    .map(|kind| self.kind(kind))
                    .collect::<Vec<_>>()
                    .join(", or ");
            }
        }
        match &schema["type"] {
            Value::String(name) => self.named(name, schema),
            Value::Array(names) => {
                let names = names
                    .iter()
                    .filter_map(Value::as_str)
                    .filter(|name| *name != "null");
                names
                    .map(|name| self.named(name, schema))
                    .collect::<Vec<_>>()
                    .join(" or ")
            }
            _ => "anything".to_string(),
        }
    }

    /// Describes a type of JSON in words.
    fn named(&mut self, name: &str, schema: &Value) -> String {
        match name {
            "string" => "text".to_string(),
            "integer" => "whole number".to_string(),
            "boolean" => "true or false".to_string(),
            "array" => {
                let count = match (schema["minItems"].as_u64(), schema["maxItems"].as_u64()) {
                    (Some(least), Some(most)) if least == most => format!("{least} "),
                    (Some(least), Some(most)) => format!("{least} to {most} "),
                    _ => "list of ".to_string(),
                };
                format!("{count}{}", several(self.kind(&schema["items"])))
            }
            "object" => match &schema["additionalProperties"] {
                of_names @ Value::Object(_) => {
                    format!("table, by name, of {}", self.kind(of_names))
                }
                _ if schema["properties"].is_object() => {
                    let keys = schema["properties"].as_object();
                    let keys = keys
                        .into_iter()
                        .flatten()
                        .map(|(key, _)| format!("`{key}`"));
                    format!("table of {}", keys.collect::<Vec<_>>().join(", "))
                }
                _ => "table".to_string(),
            },
            other => other.to_string(),
        }
    }

    /// Returns a link to a definition, which is queued for writing if it is not on the page yet.
    fn link(&mut self, name: &str) -> String {
        if !self.seen.iter().any(|seen| seen == name) && self.definitions.contains_key(name) {
            self.seen.push(name.to_string());
            self.waiting.push_back(name.to_string());
        }
        format!("[{name}](#{})", name.to_lowercase())
    }
}

/// Formats a text for a cell of a table.
fn in_line(text: &str) -> String {
    let text = without_links(text);
    let words: Vec<&str> = text.split_whitespace().collect();
    words.join(" ").replace('|', "\\|")
}

/// Takes the brackets off links between Rust items, which lead nowhere on a page.
fn without_links(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some((before, link)) = rest.split_once("[`") {
        out.push_str(before);
        match link.split_once('`') {
            Some((name, after)) if after.starts_with(']') => {
                out.push_str(&format!("`{name}`"));
                rest = &after[1..];
            }
            _ => {
                out.push_str("[`");
                rest = link;
            }
        }
    }
    out + rest
}

/// Several values of a kind, in words.
fn several(kind: String) -> String {
    match kind.as_str() {
        "number" | "text" | "whole number" => format!("{kind}s"),
        numbers if numbers.starts_with(|c: char| c.is_ascii_digit()) => format!("rows of {kind}"),
        _ => match kind.strip_prefix("list of ") {
            Some(items) => format!("lists of {items}"),
            None => kind,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn keys_have_type_default_and_meaning_and_definitions_follow() {
        let schema = json!({
            "properties": {
                "on": { "type": "string", "description": "Where\nit | acts." },
                "size": { "type": ["number", "null"], "default": 1.5 },
                "way": { "anyOf": [{ "$ref": "#/$defs/Way" }, { "type": "null" }] },
            },
            "required": ["on"],
            "$defs": {
                "Way": {
                    "description": "A way.",
                    "oneOf": [{ "const": "up", "description": "Upwards." }],
                },
                "Unused": { "type": "number" },
            },
        });
        assert_eq!(
            page(&schema, "A page", "About."),
            "# A page

About.

| key | type | default | meaning |
|---|---|---|---|
| `on` | text | required | Where it \\| acts. |
| `size` | number | `1.5` |  |
| `way` | [Way](#way) |  |  |

## Way

A way.

- `\"up\"`: Upwards.
"
        );
    }

    #[test]
    fn links_between_items_lose_their_brackets() {
        for (text, wanted) in [
            ("See [`crate::a`], or [`B`].", "See `crate::a`, or `B`."),
            (
                "Rows `[C, gamma]`, [`a`, `b`].",
                "Rows `[C, gamma]`, [`a`, `b`].",
            ),
        ] {
            assert_eq!(without_links(text), wanted);
        }
    }
}
