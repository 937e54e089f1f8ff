//! Overrides: `key.path=value` applied to the document before it is read, so that a mistyped key
//! gets the same checks as one in the file.
//!
//! A table is merged key by key with the table already there; any other value replaces the old one.
//! `key.path=` without a value removes the key.

use super::document::{SceneSource, join};
use crate::error::{Error, Result};
use std::borrow::Cow;
use toml::Spanned;
use toml::de::{DeArray, DeString, DeTable, DeValue};

/// Applies all overrides in order; later ones win. Returns warnings about keys that are lost
/// because a new list of tables no longer has them.
///
/// # Errors
/// `Input`, naming the override by its text: no `=`, a key that is not a TOML key path, a value
/// that looks like a TOML array, table or string but is not valid, a step into a value that is not
/// a table, an array element that does not exist, a key to remove that does not exist.
pub(super) fn apply<'i>(source: &SceneSource<'i>, root: &mut DeTable<'i>) -> Result<Vec<String>> {
    let mut lost = Vec::new();
    for (number, text) in source.overrides.iter().enumerate() {
        apply_one(text, source.override_place(number), root, &mut lost)
            .map_err(|error| error.within(format!("--set {text}")))?;
    }
    Ok(lost)
}

fn apply_one<'i>(
    text: &'i str,
    place: usize,
    root: &mut DeTable<'i>,
    lost: &mut Vec<String>,
) -> Result<()> {
    let Some((key, value)) = text.split_once('=') else {
        return Err(Error::input(
            "an override is KEY=VALUE, for instance program.steps=40; this one has no `=`",
        ));
    };
    let segments = segments(key)?;
    let value = match value.trim() {
        "" => None,
        value => Some(Spanned::new(
            place..place,
            placed(parse_value(value)?, place),
        )),
    };
    let Some((last, parents)) = segments.split_last() else {
        return Err(Error::input("the key before `=` is empty"));
    };
    let whole = segments.join(".");
    let Some((first, rest)) = parents.split_first() else {
        return match value {
            Some(value) => {
                put(root, last, value, &whole, lost);
                Ok(())
            }
            None => remove(root, last, "the scene"),
        };
    };
    let mut path = first.clone();
    let mut at = entry(root, first, place);
    for segment in rest {
        at = step(at, segment, &path, place)?;
        path = join(&path, segment);
    }
    match (at, value) {
        (DeValue::Table(table), Some(value)) => put(table, last, value, &whole, lost),
        (DeValue::Table(table), None) => remove(table, last, &format!("`{path}`"))?,
        (DeValue::Array(array), Some(value)) => {
            replace(element(array, last, &path)?, value, &whole, lost);
        }
        (DeValue::Array(_), None) => {
            return Err(Error::input(format!(
                "an entry of the list `{path}` cannot be removed; give the whole list: {path}=[...]"
            )));
        }
        (other, _) => return Err(no_table(&path, other)),
    }
    Ok(())
}

/// Puts `value` at `key`, merging tables.
fn put<'i>(
    table: &mut DeTable<'i>,
    key: &str,
    mut value: Spanned<DeValue<'i>>,
    path: &str,
    lost: &mut Vec<String>,
) {
    let place = value.span();
    // The key is removed and inserted again, because the old key would keep its place in the file.
    if let Some(old) = table.remove(key) {
        let new = std::mem::replace(&mut value, old);
        replace(&mut value, new, path, lost);
    }
    table.insert(Spanned::new(place, Cow::Owned(key.to_string())), value);
}

/// Merges a table with a table; any other new value replaces the old one.
fn replace<'i>(
    old: &mut Spanned<DeValue<'i>>,
    new: Spanned<DeValue<'i>>,
    path: &str,
    lost: &mut Vec<String>,
) {
    let place = new.span();
    match (old.get_mut(), new.into_inner()) {
        (DeValue::Table(table), DeValue::Table(given)) => {
            for (key, value) in given {
                let key = key.into_inner();
                put(table, &key, value, &join(path, &key), lost);
            }
        }
        (there, new) => {
            if let (DeValue::Array(there), DeValue::Array(new)) = (&*there, &new) {
                lost.extend(missing_keys(there, new, path));
            }
            *old = Spanned::new(place, new);
        }
    }
}

/// A warning about the keys that all tables of the old list have and no table of the new list has.
fn missing_keys(old: &DeArray<'_>, new: &DeArray<'_>, path: &str) -> Option<String> {
    let first = old.first()?.get_ref().as_table()?;
    let has = |item: &Spanned<DeValue>, key: &str| item.get_ref().get(key).is_some();
    let missing: Vec<String> = first
        .keys()
        .map(|key| key.get_ref().as_ref())
        .filter(|key| old.iter().all(|item| has(item, key)))
        .filter(|key| !new.iter().any(|item| has(item, key)))
        .map(|key| format!("`{key}`"))
        .collect();
    (!missing.is_empty() && !new.is_empty()).then(|| {
        format!(
            "--set {path}=[...] replaces the list; its entries no longer have {}",
            missing.join(", ")
        )
    })
}

fn remove(table: &mut DeTable<'_>, key: &str, whose: &str) -> Result<()> {
    match table.remove(key) {
        Some(_) => Ok(()),
        None => Err(Error::input(format!(
            "{whose} has no key `{key}` that could be removed; KEY= without a value removes a key"
        ))),
    }
}

/// Splits a key path into its parts by TOML's own rules, so that quoted keys work.
fn segments(key: &str) -> Result<Vec<String>> {
    let key = key.trim();
    let wrong = |reason: &str| {
        Error::input(format!(
            "`{key}` is not a key path such as materials.steel.yield_stress or contact.0.gap: \
             {reason}"
        ))
    };
    if key.contains('\n') {
        return Err(wrong("it has a line break"));
    }
    let line = format!("{key} = 0");
    let mut table = DeTable::parse(&line)
        .map_err(|error| wrong(error.message()))?
        .into_inner();
    let mut segments = Vec::new();
    // One line with one number at its end parses as a chain of tables with one key each.
    while let Some((key, value)) = table.into_iter().next() {
        segments.push(key.into_inner().into_owned());
        match value.into_inner() {
            DeValue::Table(inner) => table = inner,
            _ => break,
        }
    }
    Ok(segments)
}

/// Parses a TOML value; a bare word is taken as a string.
fn parse_value(text: &str) -> Result<DeValue<'_>> {
    match DeValue::parse(text) {
        Ok(value) => Ok(value.into_inner()),
        Err(error) if text.starts_with(['[', '{', '"', '\'']) => Err(Error::input(format!(
            "the value `{text}` is not valid TOML: {}",
            error.message()
        ))),
        Err(_) => Ok(DeValue::String(DeString::Borrowed(text))),
    }
}

/// Assigns the place of the override to all parts of the value.
fn placed(value: DeValue<'_>, place: usize) -> DeValue<'_> {
    match value {
        DeValue::Table(table) => DeValue::Table(
            table
                .into_iter()
                .map(|(key, value)| {
                    (
                        Spanned::new(place..place, key.into_inner()),
                        Spanned::new(place..place, placed(value.into_inner(), place)),
                    )
                })
                .collect(),
        ),
        DeValue::Array(array) => {
            let mut items = DeArray::new();
            for item in array {
                items.push(Spanned::new(place..place, placed(item.into_inner(), place)));
            }
            DeValue::Array(items)
        }
        other => other,
    }
}

/// The value of `key`, created as an empty table if it is absent. An unknown key is reported later,
/// when the scene is read.
fn entry<'t, 'i>(table: &'t mut DeTable<'i>, key: &str, place: usize) -> &'t mut DeValue<'i> {
    table
        .entry(Spanned::new(place..place, Cow::Owned(key.to_string())))
        .or_insert_with(|| Spanned::new(place..place, DeValue::Table(DeTable::new())))
        .get_mut()
}

fn step<'t, 'i>(
    at: &'t mut DeValue<'i>,
    segment: &str,
    path: &str,
    place: usize,
) -> Result<&'t mut DeValue<'i>> {
    match at {
        DeValue::Table(table) => Ok(entry(table, segment, place)),
        DeValue::Array(array) => Ok(element(array, segment, path)?.get_mut()),
        other => Err(no_table(path, other)),
    }
}

/// The array element that a path segment refers to, by its index from 0 or by its `name` (for a
/// part, its `body`).
fn element<'t, 'i>(
    array: &'t mut DeArray<'i>,
    segment: &str,
    path: &str,
) -> Result<&'t mut Spanned<DeValue<'i>>> {
    let names: Vec<Option<&str>> = array.iter().map(|item| name(item.get_ref())).collect();
    let index = match segment.parse::<usize>() {
        Ok(index) => Some(index),
        Err(_) => names.iter().position(|name| *name == Some(segment)),
    };
    let missing = format!(
        "`{path}` has no entry `{segment}`; {}",
        match (array.len(), names.iter().flatten().count()) {
            (0, _) => "it is empty".to_string(),
            (n, 0) => format!("use an index from 0 to {}", n - 1),
            (n, _) => {
                let names: Vec<&str> = names.iter().flatten().copied().collect();
                format!(
                    "use an index from 0 to {} or a name: {}",
                    n - 1,
                    names.join(", ")
                )
            }
        }
    );
    index
        .and_then(|index| array.get_mut(index))
        .ok_or_else(|| Error::input(missing))
}

/// The name by which an entry of an array of tables can be referred to.
fn name<'v>(item: &'v DeValue<'_>) -> Option<&'v str> {
    let named = item.get("name").or_else(|| item.get("body"))?;
    named.get_ref().as_str()
}

fn no_table(path: &str, found: &DeValue<'_>) -> Error {
    Error::input(format!(
        "`{path}` is a value of type {}, it has no keys of its own",
        found.type_str()
    ))
}
