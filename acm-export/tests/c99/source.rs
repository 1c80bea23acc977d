//! The source by itself: warnings are errors, no library is called, its own test passes and can fail.

use std::process::Command;

use acm_core::effects::Carrier;
use acm_export::{c99, fingerprint};
use acm_stream::{Nominal, Parts, StateRule};

use crate::compile::{compilers, link, origin, written};
use crate::robots::{augmented, bodies, parts, rig, term};

/// A network of each kind on an arm with effects of every place.
fn estimators() -> Vec<Parts> {
    let names = ["measurement_delay", "bouc_wen", "second_order_lag", "downwash", "misregistration"];
    let carrier = |name: &str| if name == "downwash" { Carrier::Context(0) } else { Carrier::Rig };
    let terms: Vec<_> = names.iter().map(|name| term(name, carrier(name), &rig())).collect();
    let of = |(k, body): (usize, _)| {
        let state = if k % 2 == 0 { StateRule::Running } else { StateRule::Window(5) };
        parts(body, Nominal::Augmented(augmented(terms.clone())), state)
    };
    bodies().into_iter().step_by(3).enumerate().map(of).collect()
}

#[test]
fn compilers_find_nothing_and_sanitizers_neither() {
    for cc in compilers() {
        for parts in estimators() {
            let folder = written(&parts);
            for flags in [&["-O2", "-DSELFTEST"][..], &["-O1", "-g", "-DSELFTEST", "-fsanitize=address,undefined"]] {
                let flags = [flags, &["-Wconversion", "-Wshadow"]].concat();
                let program = link(cc, &folder, &["estimator.c"], &flags);
                let output = Command::new(program).output().expect("it runs");
                let said = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
                assert!(output.status.success(), "{cc}, {:?}: {said}", parts.network.body);
            }
        }
    }
}

/// One digit of one weight.
#[test]
fn the_self_test_finds_a_changed_weight() {
    for cc in compilers() {
        let folder = written(&estimators()[0]);
        let path = folder.path().join("estimator.c");
        let text = std::fs::read_to_string(&path).expect("a file");
        let place = text.find("HEAD[").expect("a table");
        let digit = place + text[place..].find("0.").expect("a number") + 2;
        let mut changed = text.clone().into_bytes();
        changed[digit] = if changed[digit] == b'9' { b'1' } else { changed[digit] + 1 };
        std::fs::write(&path, changed).expect("a file");
        let program = link(cc, &folder, &["estimator.c"], &["-O1", "-DSELFTEST"]);
        let status = Command::new(program).output().expect("it runs").status;
        assert_eq!(status.code(), Some(1), "{cc}");
    }
}

/// No allocation and no mathematics library: the object asks for nothing but copying and filling of memory.
#[test]
fn the_object_calls_nothing() {
    for cc in compilers() {
        for parts in estimators() {
            let folder = written(&parts);
            link(cc, &folder, &["estimator.c"], &["-O2", "-c"]);
            let output = match Command::new("nm").arg("-u").arg(folder.path().join(format!("program-{cc}"))).output() {
                Ok(output) => String::from_utf8_lossy(&output.stdout).into_owned(),
                Err(_) => return eprintln!("skipped: nm is not installed"),
            };
            let known = ["memcpy", "memset", "memmove", "_GLOBAL_OFFSET_TABLE_", "__stack_chk_fail"];
            let names: Vec<&str> = output.split_whitespace().filter(|word| *word != "U").collect();
            assert!(!names.is_empty(), "copies are called");
            assert!(names.iter().all(|name| known.contains(name)), "{cc}: {names:?}");
        }
    }
}

#[test]
fn the_source_says_where_it_came_from() {
    let parts = &estimators()[0];
    let files = c99::export(parts, &origin()).expect("it can be written");
    let hash = fingerprint(parts).expect("a hash");
    assert_eq!(hash.len(), 64);
    for file in files {
        let text = String::from_utf8(file.bytes).expect("text");
        assert!(text.is_ascii() && !text.contains('$') && !text.contains('@'), "{:?}", file.path);
        assert!(text.contains(&hash) && text.contains("from     a test"), "{:?}", file.path);
    }
}
