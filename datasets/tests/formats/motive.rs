//! Versions of Motive's CSV, made by hand.

use acm_datasets::formats::{self, Format, Keep, Take};

/// Reads a text as a file.
pub fn read(text: &str) -> Result<Take, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("take.csv");
    std::fs::write(&path, text).expect("written");
    assert_eq!(formats::recognise(&path), Ok(Some(Format::Motive)));
    formats::read(&path, Format::Motive, Keep::All).map_err(|e| e.to_string())
}

/// A body and a marker, three frames at 120 Hz with times in milliseconds.
pub const V123: &str = "\
Format Version,1.23,Take Name,a,Capture Frame Rate,120.000000,Export Frame Rate,120.000000,Total Exported Frames,3,\
Rotation Type,XYZ,Length Units,Millimeters,Coordinate Space,Global\r
\r
,Type,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body Marker,Rigid Body Marker,Rigid Body Marker,Marker,Marker,Marker\r
,Name,Tip,Tip,Tip,Tip,Tip,Tip,Tip,Tip:Marker1,Tip:Marker1,Tip:Marker1,Tip:Marker1,Tip:Marker1,Tip:Marker1\r
,ID,\"1\",\"1\",\"1\",\"1\",\"1\",\"1\",\"1\",\"2\",\"2\",\"2\",\"2\",\"2\",\"2\"\r
,,Rotation,Rotation,Rotation,Position,Position,Position,Mean Marker Error,Position,Position,Position,Position,Position,Position\r
Frame,Time (Seconds),X,Y,Z,X,Y,Z,,X,Y,Z,X,Y,Z\r
1,0.008,10,20,30,1,2,3,0.1,4,5,6,7,8,9\r
2,0.017,11,21,31,1,2,3,0.1,4,5,6,,,\r
3,0.025,12,22,32,1,2,3,0.1,4,5,6,7,8,9\r
";

/// Oracle: by hand.
#[test]
fn a_take_of_version_1_23_has_names_units_and_exact_times() {
    let take = read(V123).expect("read");
    let group = &take.groups[0];
    assert_eq!(group.time, [1.0 / 120.0, 2.0 / 120.0, 3.0 / 120.0]);
    let of = |name: &str| take.column(name).map(|(_, c)| (c.unit, c.values.clone()));
    assert_eq!(of("Tip.Rotation.Y"), Some((Some("deg"), vec![20.0, 21.0, 22.0])));
    assert_eq!(of("Tip.Position.Z"), Some((Some("mm"), vec![3.0, 3.0, 3.0])));
    assert_eq!(of("Tip.Mean Marker Error"), Some((Some("mm"), vec![0.1, 0.1, 0.1])));
    assert_eq!(of("Tip.Marker1.solved.X"), Some((Some("mm"), vec![4.0, 4.0, 4.0])));
    let (unit, measured) = of("Tip.Marker1.X").expect("measured");
    assert_eq!((unit, measured[0], measured[2]), (Some("mm"), 7.0, 7.0));
    assert!(measured[1].is_nan(), "an occlusion");
    assert_eq!((group.first_row, take.lost.len()), (8, 0));
}

/// Version 1.25 has a row more, 1.24 may have a column more, and the first row may be absent.
#[test]
fn other_versions_are_read_alike() {
    let before = read(V123).expect("read");
    let parent = V123.replace(",ID,", ",Parent,,,,,,,,Tip,Tip,Tip,,,\r\n,ID,");
    assert_eq!(read(&parent).expect("1.25").groups[0].columns.len(), 13);
    let names = |take: &Take| take.groups[0].columns.iter().map(|c| c.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&read(&parent).expect("1.25")), names(&before));
    let mut coded = String::new();
    for line in V123.replace("(Seconds),", "(Seconds),TimeCode,").lines() {
        let cells: Vec<&str> = line.splitn(3, ',').collect();
        let inserted = match cells[0] {
            "" if cells.len() == 3 => format!(",{},,{}", cells[1], cells[2]),
            "1" | "2" | "3" => format!("{},{},10:00:00:01.5,{}", cells[0], cells[1], cells[2]),
            _ => line.to_string(),
        };
        coded += &(inserted + "\n");
    }
    let coded = read(&coded).expect("1.24");
    assert_eq!(names(&coded), names(&before));
    assert_eq!(coded.groups[0].columns[1], before.groups[0].columns[1]);
    let headless = V123.split_once("\r\n\r\n").expect("two rows").1;
    let take = read(headless).expect("without its first row");
    assert_eq!(take.groups[0].time, [0.008, 0.017, 0.025], "the rounded times, without a rate");
    assert_eq!(take.column("Tip.Position.X").map(|(_, c)| c.unit), Some(None), "no unit is declared");
    assert!(take.notes.iter().any(|note| note.contains("no frame rate is declared")), "{:?}", take.notes);
}

#[test]
fn what_is_wrong_is_told_with_row_column_and_value() {
    let said = |text: &str| read(text).expect_err("refused");
    let message = said(&V123.replace("2,0.017,11,21", "2,0.017,11,1O0"));
    assert!(message.contains("row 9, column `Tip.Rotation.Y`: \"1O0\" is not a number"), "{message}");
    let message = said(&V123.replace("2,0.017,11,21,31,1,2,3,0.1,4,5,6,,,", "2,0.017,11"));
    assert!(message.contains("row 9: 3 cells under 15 columns"), "{message}");
    let take = read(&V123[..V123.len() - 12]).expect("a last row that is cut off");
    assert_eq!((take.groups[0].samples, take.lost.len()), (2, 2), "{:?}", take.lost);
    assert!(take.lost[0].contains("row 10 is cut off after 10 of 15 cells"), "{:?}", take.lost);
    assert!(take.lost[1].contains("promises 3 frames, and the file has 2"), "{:?}", take.lost);
}
