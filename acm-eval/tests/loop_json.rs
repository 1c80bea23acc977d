//! `loop.json` of format 2: the same keys whatever the unit, and a line of the book for each.

mod delayed;

use std::{collections::BTreeSet, fs, path::Path};

use acm_trace::search::criteria::Criteria;
use delayed::{MANIFEST, Rig};
use serde_json::Value;

fn chapter(name: &str) -> String {
    let path = Path::new("../book/src").join(name);
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Keys of an object and of all inside it, with their places; `*` is any element of a list.
fn keys(value: &Value, place: &str, found: &mut BTreeSet<String>) {
    match value {
        Value::Object(fields) => {
            for (key, value) in fields {
                let place = format!("{place}.{key}");
                found.insert(place.clone());
                keys(value, &place, found);
            }
        }
        Value::Array(elements) => elements.iter().for_each(|element| keys(element, &format!("{place}.*"), found)),
        _ => {}
    }
}

fn all_keys(found: &Value) -> BTreeSet<String> {
    let mut all = BTreeSet::new();
    keys(found, "", &mut all);
    all
}

/// Names in the first column of the table below a heading, without their backticks.
fn documented(chapter: &str, heading: &str) -> Vec<String> {
    let (_, rest) = chapter.split_once(&format!("\n## {heading}\n")).unwrap_or_else(|| panic!("no {heading}"));
    let section = rest.split("\n## ").next().unwrap();
    let cells = section.lines().filter_map(|line| line.strip_prefix("| `")?.split_once("` |").map(|(name, _)| name));
    cells.map(String::from).collect()
}

fn own(found: &Value) -> BTreeSet<String> {
    found.as_object().unwrap().keys().cloned().collect()
}

/// The same recordings in millimetres and in newtons: the same keys, and no key that names a unit.
#[test]
fn keys_do_not_depend_on_the_unit() {
    let closed = |unit: &str| {
        let rig = Rig::new();
        let output = "column = \"x\"\nunit   = \"m\"";
        assert!(MANIFEST.contains(output));
        rig.write("arm/manifest.toml", &MANIFEST.replace(output, &format!("column = \"x\"\nunit   = \"{unit}\"")));
        rig.close(&["arm"], "out").1
    };
    let (lengths, forces) = (closed("mm"), closed("N"));
    assert_eq!((&lengths["errors"]["unit"], &forces["errors"]["unit"]), (&"m".into(), &"N".into()));
    let ratio =
        forces["errors"]["after"]["value"].as_f64().unwrap() / lengths["errors"]["after"]["value"].as_f64().unwrap();
    assert!((ratio / 1000.0 - 1.0).abs() < 0.2, "errors are in SI units: {ratio}");
    let (lengths, forces) = (all_keys(&lengths), all_keys(&forces));
    assert_eq!(lengths, forces);
    assert!(lengths.len() > 80 && lengths.iter().all(|key| !key.ends_with("_mm")), "{lengths:?}");
}

/// Each key of a real file has its line, and each line its key.
#[test]
fn the_book_has_every_key() {
    let found = Rig::new().close(&["arm"], "out").1;
    let text = chapter("loop-json.md");
    let effect = &found["effects"][0];
    for (heading, object) in [
        ("Top level", &found),
        ("An effect", effect),
        ("A parameter", &effect["parameters"][0]),
        ("A step", &found["steps"][0]),
        ("Left", &found["left"]),
    ] {
        let lines: BTreeSet<String> = documented(&text, heading).into_iter().collect();
        assert_eq!(lines, own(object), "{heading}");
    }
    let lines: BTreeSet<String> = documented(&text, "Errors").into_iter().collect();
    let mut errors = own(&found["errors"]);
    errors.insert("after_without_offsets".into());
    assert_eq!(lines, errors);
}

/// Oracle: the fields as the program itself writes them out.
#[test]
fn the_book_has_every_criterion_with_its_default() {
    let written = format!("{:#?}", Criteria::default());
    let fields: Vec<(String, f64)> = written
        .lines()
        .filter_map(|line| line.trim().strip_suffix(',')?.split_once(": "))
        .map(|(name, value)| (name.to_string(), value.parse().unwrap()))
        .collect();
    let rows: Vec<(String, f64)> = chapter("criteria.md")
        .lines()
        .filter_map(|line| line.strip_prefix("| `")?.split_once("` | "))
        .map(|(name, rest)| (name.to_string(), rest.split(" |").next().unwrap().parse().unwrap()))
        .collect();
    assert!(fields.len() > 10);
    assert_eq!(rows, fields);
}

/// Numbers in a text, such as 3, 20 and 0.06 in "3 s, 20 samples, 0.06".
fn numbers(text: &str) -> Vec<f64> {
    let plain = text.replace(|c: char| !(c.is_ascii_alphanumeric() || "._-".contains(c)), " ").replace('_', "");
    plain.split_whitespace().filter_map(|word| word.parse().ok()).collect()
}

/// Oracle: the sources, in which each constant is declared with the numbers that the book gives it.
#[test]
fn the_book_has_constants_with_their_files_and_values() {
    let mut compared = 0;
    for line in chapter("criteria.md").lines() {
        let cells: Vec<&str> = line.split(" | ").map(|cell| cell.trim_start_matches("| ")).collect();
        let Some(file) = cells.first().filter(|file| file.ends_with(".rs")) else { continue };
        let (library, file) = file.split_once(' ').unwrap_or(("acm-trace", file));
        let source = fs::read_to_string(Path::new("..").join(library).join("src").join(file))
            .unwrap_or_else(|error| panic!("{file}: {error}"));
        let declared: Vec<f64> = cells[1]
            .split(", ")
            .flat_map(|name| {
                let name = name.trim_matches('`');
                let (_, rest) =
                    source.split_once(&format!("const {name}: ")).unwrap_or_else(|| panic!("{file}: {name}"));
                let (_, value) = rest.split_once(" = ").unwrap();
                numbers(value.split_once(";\n").unwrap().0)
            })
            .collect();
        let told = numbers(&cells[2].replace(',', if cells[2].contains(", ") { " " } else { "" }));
        assert!(!told.is_empty() && told.iter().all(|number| declared.contains(number)), "{line}\n{declared:?}");
        compared += 1;
    }
    assert!(compared > 20);
}
