//! As much of JSON Schema (draft 2020-12) as `docs/check.schema.json` uses, to hold what the program writes against it.

use serde_json::Value;

/// What of `value` does not fit `schema`, with its place; references are looked up in `root`. Keywords that are not
/// known here are an error of the schema, so that nothing passes unchecked.
pub fn misfits(value: &Value, schema: &Value, root: &Value) -> Vec<String> {
    let mut found = Vec::new();
    check(value, schema, root, "", &mut found);
    found
}

fn check(value: &Value, schema: &Value, root: &Value, path: &str, found: &mut Vec<String>) {
    for (keyword, rule) in schema.as_object().expect("a schema is an object") {
        let mut say = |what: String| found.push(format!("{path}: {what}"));
        match keyword.as_str() {
            "$schema" | "$defs" | "title" | "description" => {}
            "$ref" => {
                let pointer =
                    rule.as_str().and_then(|r| r.strip_prefix('#')).expect("a reference into the file");
                let target = root.pointer(pointer).unwrap_or_else(|| panic!("no {pointer}"));
                check(value, target, root, path, found);
            }
            "oneOf" => {
                let fits = |s: &&Value| misfits(value, s, root).is_empty();
                let cases = rule.as_array().expect("a list of schemas");
                let count = cases.iter().filter(fits).count();
                if count != 1 {
                    say(format!("fits {count} of the cases"));
                    cases.iter().for_each(|s| check(value, s, root, path, found));
                }
            }
            "const" if value != rule => say(format!("is {value}, not {rule}")),
            "enum" if !rule.as_array().expect("a list").contains(value) => {
                say(format!("is {value}, not one of {rule}"))
            }
            "type" => {
                let one = std::slice::from_ref(rule);
                let names = rule.as_array().map_or(one, Vec::as_slice);
                if !names.iter().any(|n| is(value, n.as_str().expect("the name of a type"))) {
                    say(format!("is {value}, not {rule}"));
                }
            }
            "minimum" | "maximum" | "exclusiveMinimum" => {
                let limit = rule.as_f64().expect("a number");
                let fits = |x: f64| match keyword.as_str() {
                    "minimum" => x >= limit,
                    "maximum" => x <= limit,
                    _ => x > limit,
                };
                if !value.as_f64().is_none_or(fits) {
                    say(format!("is {value}: {keyword} {rule}"));
                }
            }
            "minItems" | "maxItems" => {
                let count = value.as_array().map_or(0, Vec::len) as u64;
                let limit = rule.as_u64().expect("a count");
                if (keyword == "minItems" && count < limit) || (keyword == "maxItems" && count > limit) {
                    say(format!("has {count} items: {keyword} {rule}"));
                }
            }
            "items" => {
                for (k, item) in value.as_array().into_iter().flatten().enumerate() {
                    check(item, rule, root, &format!("{path}/{k}"), found);
                }
            }
            "required" => {
                for name in rule.as_array().expect("a list").iter().filter_map(Value::as_str) {
                    if value.is_object() && value.get(name).is_none() {
                        say(format!("has no {name}"));
                    }
                }
            }
            "properties" => {
                for (name, rule) in rule.as_object().expect("named schemas") {
                    if let Some(field) = value.get(name) {
                        check(field, rule, root, &format!("{path}/{name}"), found);
                    }
                }
            }
            "const" | "enum" => {}
            other => panic!("{other} is not checked here"),
        }
    }
}

fn is(value: &Value, name: &str) -> bool {
    match name {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "null" => value.is_null(),
        "number" => value.is_number(),
        "integer" => value.is_u64() || value.is_i64(),
        other => panic!("{other} is no type"),
    }
}
