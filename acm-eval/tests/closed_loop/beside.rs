//! Files beside a page: linked, and with every digit.

use std::path::PathBuf;

use acm_eval::closed_loop::page::beside;
use acm_eval::closed_loop::{page, separability_page};

use crate::{browser, findings};

/// A page and what lies beside it, in a folder.
fn written(html: &str, files: Vec<(String, Vec<u8>)>) -> (tempfile::TempDir, PathBuf) {
    let root = tempfile::tempdir().unwrap();
    ["figures", "tables"].iter().for_each(|inside| std::fs::create_dir(root.path().join(inside)).unwrap());
    files.iter().for_each(|(name, bytes)| std::fs::write(root.path().join(name), bytes).unwrap());
    let page = root.path().join("page.html");
    std::fs::write(&page, html).unwrap();
    (root, page)
}

#[test]
fn every_link_leads_to_a_file_and_every_file_is_linked() {
    for (name, finding) in findings::all() {
        let (_root, page) = written(&page(&finding), beside::of_finding(&finding).unwrap());
        eprintln!("{name}");
        browser::links_resolve(&page);
    }
    let separability = findings::separability();
    let (_root, page) = written(&separability_page(&separability), beside::of_separability(&separability).unwrap());
    browser::links_resolve(&page);
}

/// Oracle: the fixture's own numbers, which the files hold with every digit.
#[test]
fn tables_beside_the_page_have_every_digit() {
    let finding = findings::form_imperfect();
    let files = beside::of_finding(&finding).unwrap();
    let table = |name: &str| {
        let found = files.iter().find(|(file, _)| *file == format!("tables/{name}.csv"));
        String::from_utf8(found.unwrap_or_else(|| panic!("no {name}")).1.clone()).unwrap()
    };
    let parameters = table("parameters");
    assert!(parameters.starts_with("Effect,Carried by,Parameter,Value,95 % from,95 % to,Unit,"), "{parameters}");
    assert!(parameters.contains("width_q1,0.05236,0.0511,0.0537,rad"), "{parameters}");
    let effects = table("effects");
    assert!(
        effects.starts_with("Effect,Carried by,Size [m],Confidence,Share of resamples,Chosen in its place"),
        "{effects}"
    );
    assert!(effects.contains("backlash,q1,0.0083,sure,0.97,creep(q2) 0.02; no effect 0.01"), "{effects}");
    let steps = table("steps");
    assert!(steps.contains("+ backlash,0.00266,0.87,0.021,14.2,yes,3") && steps.contains(",0.3,no,2"), "{steps}");
    let before = table("before-and-after");
    assert!(
        before.starts_with("Model,Error [m],")
            && before.contains("at its place in the model\",confirmed")
            && before.contains("white noise,0.0026,,,"),
        "{before}"
    );
    assert!(table("networks").contains("nominal + effect + network,0.00271,0.00004"));
    assert!(table("candidates").contains("+ backlash,prandtl_ishlinskii,0.00267"));
    assert!(
        beside::of_finding(&findings::no_effect()).unwrap().iter().all(|(file, _)| file != "tables/parameters.csv")
    );
}
