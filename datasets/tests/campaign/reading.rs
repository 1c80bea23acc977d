//! What a set in order becomes.

use acm_datasets::files::table::{Column, write_parquet};
use acm_datasets::{Campaign, DomainFilter, DropReason, Role, domain_filter, series};
use nalgebra::DMatrix;

use super::set::{self, Set};

fn with_manifest(from: &str, to: &str) -> Set {
    let set = Set::new();
    set.edit("manifest.toml", from, to);
    set
}

/// Oracle: the written rows, converted by hand: ms, deg, cm, mm.
#[test]
fn values_are_si() {
    let campaign = Set::new().campaign();
    let trial = campaign.trial("b").expect("trial b");
    let rows = set::rows(1);
    assert_eq!(trial.samples(), 60);
    for (t, row) in rows.iter().enumerate() {
        assert_eq!(trial.time[t], row[0] / 1000.0);
        assert!((trial.actuators[(t, 0)] - row[1].to_radians()).abs() < 1e-15);
        assert_eq!(trial.context[(t, 0)], row[2] / 100.0);
        assert_eq!(trial.measured[(t, 0)], row[3] / 1000.0);
    }
    assert_eq!(
        campaign.trials.iter().map(|t| t.role).collect::<Vec<_>>(),
        [Role::Development, Role::Development, Role::HeldOut, Role::Calibration]
    );
    assert_eq!(campaign.folds().validation, [["a"], ["b"]]);
    assert_eq!(campaign.tip_columns(), 0..1);
}

#[test]
fn csv_and_parquet_give_the_same_trials() {
    let set = with_manifest("[\"run_*.csv\"]", "[\"run_*.parquet\"]");
    for (i, name) in ["a", "b", "c", "d"].iter().enumerate() {
        std::fs::remove_file(set.file(&format!("run_{name}.csv"))).expect("remove");
        set::parquet(&set.file(&format!("run_{name}.parquet")), &set::rows(i));
    }
    let (mut found, expected) = (set.campaign().trials, Set::new().campaign().trials);
    found.iter_mut().zip(&expected).for_each(|(found, expected)| found.file = expected.file.clone());
    assert_eq!(found, expected);
}

/// One table with a column of trial names, whose rows are mixed; text and numbers as names.
#[test]
fn trials_by_column_are_gathered_in_time() {
    for parquet in [false, true] {
        let set = with_manifest("{ file = \"run_(.*)\" }", "{ column = \"run\" }");
        set.edit("manifest.toml", "run_*.csv", if parquet { "all.parquet" } else { "all.csv" });
        set.edit("manifest.toml", "\"d\"", "\"4\"").edit("manifest.toml", "\"a\", \"b\"", "\"1\", \"2\"");
        set.edit("manifest.toml", "\"c\"", "\"3\"");
        let mixed: Vec<(usize, [f64; 4])> = (0..240).map(|i| (i % 4, set::rows(i % 4)[i / 4])).collect();
        if parquet {
            let number = |c: usize| Column::Number(mixed.iter().map(|(_, r)| r[c]).collect());
            let run = Column::Number(mixed.iter().map(|(i, _)| *i as f64 + 1.0).collect());
            let columns = [("run", run), ("t", number(0)), ("q", number(1)), ("h", number(2)), ("y", number(3))];
            write_parquet(&set.file("all.parquet"), &columns.map(|(n, c)| (n.to_string(), c))).expect("write");
        } else {
            let line = |(i, r): &(usize, [f64; 4])| format!("{},{},{},{},{}\n", i + 1, r[0], r[1], r[2], r[3]);
            set.write("all.csv", &("run,t,q,h,y\n".to_string() + &mixed.iter().map(line).collect::<String>()));
        }
        let (found, usual) = (set.campaign(), Set::new().campaign());
        for (a, b) in found.trials.iter().zip(&usual.trials) {
            assert_eq!((&a.time, &a.actuators, &a.measured), (&b.time, &b.actuators, &b.measured), "{parquet}");
        }
        assert_eq!(found.trials.iter().map(|t| t.name.as_str()).collect::<String>(), "1234");
    }
}

#[test]
fn time_comes_from_a_rate_or_from_sample_numbers() {
    let set = with_manifest("{ column = \"t\", unit = \"ms\" }", "{ rate_hz = 20.0 }");
    let trial = set.campaign().trials.remove(0);
    assert_eq!((trial.time[0], trial.time[1], trial.time[59]), (0.0, 0.05, 2.95));
    let set =
        with_manifest("{ column = \"t\", unit = \"ms\" }", "{ column = \"t\", unit = \"sample\", rate_hz = 50.0 }");
    let trial = set.campaign().trials.remove(0);
    assert_eq!((trial.time[0], trial.time[1], trial.time[59]), (0.0, 2.0, 118.0));
}

/// An empty measured cell is a lost marker: the sample is counted and not compared, and its inputs stay. Oracle: the rows of the set.
#[test]
fn lost_markers_are_counted_and_their_inputs_stay() {
    let mut text = set::csv(&set::rows(1));
    for t in [3, 4, 10] {
        let line = text.lines().nth(t + 1).expect("line").to_string();
        let cut = line.rfind(',').expect("comma") + 1;
        text = text.replacen(&line, &line[..cut], 1);
    }
    let set = Set::new();
    set.write("run_b.csv", &text);
    let campaign = set.campaign();
    let trial = campaign.trial("b").expect("b");
    assert_eq!(trial.samples(), 57);
    assert_eq!(trial.dropped.get(&DropReason::MissingMarker), Some(&3));
    assert_eq!(&trial.time[1..5], [0.1, 0.2, 0.5, 0.6]);
    assert_eq!(trial.measured[(3, 0)], set::rows(1)[5][3] / 1000.0);
    let (whole, own) = trial.with_unmeasured();
    assert_eq!((whole.samples(), own.len(), own[3]), (60, 57, 5));
    for (t, row) in set::rows(1).iter().enumerate() {
        assert!(
            (whole.time[t] - row[0] / 1000.0).abs() < 1e-12
                && (whole.actuators[(t, 0)].to_degrees() - row[1]).abs() < 1e-9
        );
        assert_eq!(whole.measured[(t, 0)].is_nan(), [3, 4, 10].contains(&t), "{t}");
    }
    // what leads up to a part stays with it, and the end has no use
    let part =
        |rows: std::ops::Range<usize>| trial.select(&rows.collect::<Vec<_>>()).with_unmeasured().0.into_owned().time;
    assert_eq!((part(0..3).len(), part(3..8).len(), part(8..57).len()), (3, 7, 50));
    let entry = acm_datasets::Entry::of(trial, Some(0.15));
    assert_eq!((entry.samples, entry.longest), (57, 60), "no gap in time");
    set.write("run_b.csv", &text.lines().take(12).map(|line| line.to_string() + "\n").collect::<String>());
    let last = set.campaign().trial("b").expect("b").clone();
    assert_eq!((last.samples(), last.recorded()), (8, 10), "the last of eleven samples has no output");
}

/// Steps of 100 s are no gaps, unless the gap is given.
#[test]
fn a_gap_is_relative_to_the_usual_step() {
    let set = with_manifest("unit = \"ms\"", "unit = \"s\"");
    let check = |gap: Option<f64>| Campaign::check(set.path(), None, 50, gap).map_err(|e| e.to_string());
    assert!(check(None).is_ok_and(|read| read.entries(None)[0].max_gap == 500.0));
    assert!(check(Some(0.5)).is_err_and(|text| text.contains("1 samples in one stretch without a gap over 0.5 s")));
}

#[test]
fn a_cut_makes_trials_of_their_own() {
    let set = with_manifest("\"a\", ", "");
    let cut = "[cut.a]\nhead = { until = 2.0, role = \"calibration\" }\nmiddle = { until = 3.0, role = \"excluded\" }\n\
               zz = { role = \"development\" }\n[conditions.a]\np = { value = 5, unit = \"g\" }\n\
               [conditions.\"a:zz\"]\np = { value = 7, unit = \"g\" }\n[roles]";
    set.edit("manifest.toml", "[roles]", cut);
    let (campaign, whole) = (set.campaign(), Set::new().campaign());
    let found: Vec<_> = campaign.trials.iter().map(|t| (t.name.as_str(), t.role, t.samples())).collect();
    assert_eq!(
        found[..3],
        [("a:head", Role::Calibration, 20), ("a:middle", Role::Excluded, 10), ("a:zz", Role::Development, 30)]
    );
    assert_eq!(campaign.trials[1].time[0], 2.0);
    assert_eq!(campaign.trials[2].measured, whole.trials[0].measured.rows(30, 30).into_owned());
    assert_eq!(campaign.trials[0].conditions["p"], 0.005);
    assert_eq!(campaign.trials[2].conditions["p"], 0.007);
}

#[test]
fn predicted_and_vehicle_columns_are_read() {
    let more = "[[predicted]]\ncolumn = \"h\"\nunit = \"cm\"\n[vehicle]\nposition = [\"q\", \"h\", \"y\"]\nunit = \"mm\"\n\
                attitude = [\"q\", \"q\", \"q\"]\nattitude_unit = \"deg\"\n[roles]";
    let campaign = with_manifest("[roles]", more).campaign();
    let (trial, rows) = (&campaign.trials[2], set::rows(2));
    assert_eq!(trial.predicted.as_ref().expect("predicted")[(5, 0)], rows[5][2] / 100.0);
    let vehicle = trial.vehicle.as_ref().expect("vehicle");
    assert_eq!(vehicle.shape(), (60, 6));
    assert_eq!(vehicle[(5, 1)], rows[5][2] / 1000.0);
    assert!((vehicle[(5, 5)] - rows[5][1].to_radians()).abs() < 1e-15);
}

/// The hash depends on the manifest and every data file, and on nothing else.
#[test]
fn the_hash_tells_data_apart() {
    let (usual, again) = (Set::new().campaign(), Set::new().campaign());
    assert_eq!((usual.hash.len(), &usual), (64, &Campaign { folder: usual.folder.clone(), ..again }));
    let set = Set::new();
    set.edit("run_c.csv", "\n100,", "\n101,");
    assert_ne!(set.campaign().hash, usual.hash);
    assert_ne!(with_manifest("\"small\"", "\"other\"").campaign().hash, usual.hash);
}

#[test]
fn the_same_bits_on_any_number_of_threads() {
    let set = Set::new();
    let read = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("pool");
        pool.install(|| set.campaign())
    };
    assert_eq!(read(1), read(4));
}

/// A vehicle that travels 3 km, Euler angles of 300 rad, and a quaternion of length 3; where it hovers does not matter.
#[test]
fn a_vehicle_in_another_unit_is_a_warning() {
    let warnings = |carried: &str, row: &str| {
        let set = with_manifest("[roles]", &format!("[vehicle]\n{carried}\n[roles]"));
        set.edit("run_b.csv", "\n500,", &format!("\n500,{row}\n510,"));
        set.campaign().warnings
    };
    let still = "position = [\"h\", \"h\", \"h\"]\nunit = \"m\"";
    assert_eq!(warnings(still, "0,5,0"), [""; 0]);
    let far = warnings(still, "0,3120,0");
    assert!(far[0].contains("run_b.csv: column `h` of trial `b` travels 31"), "{far:?}");
    assert!(far[0].contains("m; unit is m; did you mean mm? (factor 0.001)"), "{far:?}");
    let angles =
        "position = [\"h\", \"h\", \"h\"]\nunit = \"cm\"\nattitude = [\"y\", \"y\", \"y\"]\nattitude_unit = \"rad\"";
    let turned = warnings(angles, "0,5,300");
    let expected = ["`y`", "reaches 300.0000", "unit is rad; did you mean deg?"];
    assert!(expected.iter().all(|words| turned[0].contains(words)), "{turned:?}");
    let quaternion = angles.replace("\"y\", \"y\"", "\"y\", \"y\", \"y\"").replace("\"rad\"", "\"1\"");
    assert!(warnings(&quaternion, "0,5,3").iter().any(|warning| warning.contains("reaches")));
}

/// Compressed tables too; text that is compressed with gzip is read.
#[test]
fn tables_that_no_pattern_matches_are_named() {
    for (name, expected) in [
        ("walk_a.csv", "no pattern matches walk_a.csv; add a pattern to `files` or to `ignore`"),
        ("run_e.csv.zst", "run_e.csv.zst is compressed and not read; decompress"),
        ("run_e.csv.zip", "run_e.csv.zip is compressed and not read; decompress"),
        ("run_e.csv.xz", "run_e.csv.xz is compressed and not read; decompress"),
    ] {
        let set = Set::new();
        set.write(name, "t\n");
        let warnings = set.campaign().warnings;
        assert!(warnings.len() == 1 && warnings[0].contains(expected), "{warnings:?}");
        set.edit("manifest.toml", "files =", "ignore = [\"walk*.csv\", \"*.csv.*\"]\nfiles =");
        assert_eq!(set.campaign().warnings, [""; 0]);
    }
}

#[test]
fn data_are_found_in_the_folder_on_the_command_line() {
    let (here, there) = (Set::new(), Set::new());
    for name in ["a", "b", "c", "d"] {
        std::fs::remove_file(here.file(&format!("run_{name}.csv"))).expect("remove");
    }
    assert!(here.read().is_err());
    let campaign = Campaign::read(here.path(), Some(there.path())).expect("read");
    assert_eq!(campaign.trials, there.campaign().trials);
}

/// Two markers of an arm: the tip is the second, and both are observed.
#[test]
fn markers_have_places_and_the_tip_is_reported() {
    let axes = |marker: &str, at: f64| {
        let one = |axis| format!("[[measured]]\ncolumn = \"{axis}{marker}\"\nunit = \"m\"\nat = {at}\n");
        ["x", "y", "z"].map(one).concat()
    };
    let arm = "[arm]\nlength = { value = 400, unit = \"mm\" }\naxis = \"x\"\n[roles]\ncalibration = [\"r\"]\n";
    let manifest = "[table]\nfiles = [\"r.csv\"]\ntime = { rate_hz = 10 }\n[[actuator]]\ncolumn = \"q\"\nunit = \"1\"\n"
        .to_string()
        + &axes("1", 0.5)
        + &axes("2", 1.0) + arm;
    let set = Set::new();
    set.write("manifest.toml", &manifest);
    set.write("r.csv", "q,x1,y1,z1,x2,y2,z2\n0,0.2,0,0,0.4,0,0\n1,0.2,0.1,0,0.3,0.2,0.1\n2,0.1,0,0,0.4,0.2,0\n");
    let campaign = set.campaign();
    assert_eq!(campaign.tip_columns(), 3..6);
    assert_eq!(campaign.manifest.output_names(), ["x2", "y2", "z2"]);
    assert_eq!(campaign.manifest.name, set.path().file_name().expect("name").to_string_lossy());
    let observed = campaign.observations(&campaign.trials(Role::Calibration).collect::<Vec<_>>());
    assert_eq!((observed.at.as_slice(), observed.measured.shape()), ([0.5, 1.0].as_slice(), (3, 6)));
    assert_eq!(observed.measured[(1, 4)], 0.2);
    let acm_core::nominal::NominalSpec::Strain(arm) = campaign.nominal_spec() else { panic!("no arm") };
    assert_eq!((arm.length, arm.degree), (0.4, 3));
}

/// Residual, inputs and segments of a series; oracle: the rows of the set and differences by hand.
#[test]
fn a_series_has_inputs_rates_and_a_residual() {
    let mut rows = set::rows(1);
    rows[20..].iter_mut().for_each(|r| r[0] += 900.0);
    let set = Set::new();
    set.write("run_b.csv", &set::csv(&rows));
    set.edit("manifest.toml", "[roles]", "[conditions]\na.p = { value = 1, unit = \"N\" }\n[roles]");
    let campaign = set.campaign();
    let names = ["q", "rate(q)", "h"].map(String::from);
    let channels = campaign.channels(&names).expect("channels");
    let nominal = DMatrix::from_element(60, 1, 0.25);
    let made = series(campaign.trial("b").expect("b"), nominal, campaign.tip_columns(), &channels, 0.5);
    assert_eq!(made.segments, [0..20, 20..60]);
    assert_eq!(made.target[(7, 0)], rows[7][3] / 1000.0 - 0.25);
    assert_eq!((made.inputs[(0, 1)], made.inputs[(20, 1)]), (0.0, 0.0));
    let by_hand = (rows[21][1] - rows[20][1]).to_radians() / 0.1;
    assert!((made.inputs[(21, 1)] - by_hand).abs() < 1e-12);
    assert_eq!(made.inputs[(30, 2)], 0.135);
    for (name, expected) in
        [("z", "is unknown; the set has q h"), ("y", "is an output"), ("p", "trials b c d do not have")]
    {
        let message = campaign.channels(&[name.to_string()]).err().map(|e| e.to_string()).unwrap_or_default();
        assert!(message.contains(expected), "{message}");
    }
}

/// Calibration covers −10 to 10 deg; samples of other trials outside of it are dropped and counted.
#[test]
fn the_domain_filter_keeps_what_was_calibrated() {
    let set = Set::new();
    set.edit("run_b.csv", "\n500,", "\n500,11.5,0,7\n510,").edit("run_b.csv", "\n700,", "\n700,-40,0,7\n710,");
    let campaign = set.campaign();
    let (calibration, b) = (campaign.trial("d").expect("d"), campaign.trial("b").expect("b"));
    for filter in [DomainFilter::Hull, DomainFilter::Box] {
        let kept = domain_filter(filter, &[calibration], &[b]).expect("one actuator").remove(0);
        let (least, greatest) = (calibration.actuators.min(), calibration.actuators.max());
        let inside = |q: &&f64| (least..=greatest).contains(*q);
        assert_eq!(kept.samples(), b.actuators.iter().filter(inside).count());
        assert_eq!(kept.dropped.get(&DropReason::OutsideDomain), Some(&(62 - kept.samples())));
        assert!(kept.samples() <= 60);
    }
    assert_eq!(domain_filter(DomainFilter::None, &[calibration], &[b]).expect("none")[0], *b);
    let mut three = calibration.clone();
    three.actuators = DMatrix::zeros(60, 3);
    let message = domain_filter(DomainFilter::Hull, &[&three], &[b]).err().map(|e| (e.exit_code(), e.to_string()));
    assert!(message.is_some_and(|(code, text)| code == 2 && text.contains("choose \"box\" or \"none\"")));
}

/// Two actuators: a corner of the box that the hull leaves out.
#[test]
fn the_hull_is_tighter_than_the_box() {
    let mut calibration = Set::new().campaign().trials.remove(3);
    let corners = [0.0, 0.0, 2.0, 0.0, 0.0, 4.0];
    calibration = calibration.select(&[0, 1, 2]);
    calibration.actuators = DMatrix::from_row_slice(3, 2, &corners);
    let mut other = calibration.clone();
    other.actuators = DMatrix::from_row_slice(3, 2, &[0.5, 0.5, 1.9, 3.9, 1.0, 2.0]);
    let count = |filter| domain_filter(filter, &[&calibration], &[&other]).expect("two actuators")[0].samples();
    assert_eq!((count(DomainFilter::Hull), count(DomainFilter::Box), count(DomainFilter::None)), (2, 3, 3));
}
