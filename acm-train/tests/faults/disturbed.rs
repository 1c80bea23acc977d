//! One disturbance a test, on the real program: disks, signals, pipes, clocks, terminals.

use std::{
    fs::{self, File},
    path::Path,
    process::{Child, Command, Stdio},
    thread::sleep,
    time::Duration,
};

use crate::{
    campaign::program,
    faults::{
        disks::{self, Disk, age, refused, resumed},
        errors::{can_trace, sweep},
        kills::Undisturbed,
        questions::Question,
    },
};

/// A question with the program and the oracle.
fn asked() -> (Question, Undisturbed) {
    let question = Question::new("gru");
    let undisturbed = Undisturbed::new(&question, &program());
    (question, undisturbed)
}

/// A run on its way.
fn begun(question: &Question, out: &str) -> Child {
    let mut command = question.command(&program(), out, &["--jobs", "1"]);
    command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
}

/// Waits until a run has made a file, or has ended.
fn wait_for(child: &mut Child, file: &Path) {
    while !file.exists() && child.try_wait().unwrap().is_none() {
        sleep(Duration::from_millis(1));
    }
}

#[test]
fn a_full_disk_is_named_and_the_run_goes_on_with_more_space() {
    let (question, undisturbed) = asked();
    let Some(disk) = Disk::new(question.path("disk"), 4) else {
        return eprintln!("skipped: this process may not mount a small disk");
    };
    let mut full = 0;
    for kilobytes in [4, 12, 20, 28, 36, 44, 52] {
        disk.remount(&format!("size={kilobytes}k"));
        let output = question.command(&program(), "disk/run", &["--resume"]).output().unwrap();
        if !output.status.success() {
            refused(&output, "disk/run", &["No space left on device"]);
            let told = String::from_utf8_lossy(&output.stderr).into_owned();
            assert!(told.contains("free some space") || told.contains("make room"), "{told}");
            full += 1;
        }
    }
    assert!(full > 2, "the disk was full {full} times");
    disk.remount("size=64m");
    resumed(&question, &program(), "disk/run", &undisturbed);
}

/// `ulimit -f`: a write past the limit sends SIGXFSZ, which ends a program that does not listen.
#[test]
fn a_limit_of_file_size_is_an_error_like_a_full_disk() {
    let (question, undisturbed) = asked();
    let mut limited = 0;
    for blocks in 0..12 {
        let run = question.command(&program(), "limited", &["--resume"]);
        let limit = format!("ulimit -f {blocks}; exec \"$0\" \"$@\"");
        let mut shell = Command::new("sh");
        shell.args(["-c", &limit]).arg(run.get_program()).args(run.get_args()).current_dir(question.path(""));
        let output = shell.stdout(Stdio::piped()).output().unwrap();
        if !output.status.success() {
            refused(&output, "limited", &["File too large"]);
            limited += 1;
        }
    }
    assert!(limited > 2, "the limit was met {limited} times");
    resumed(&question, &program(), "limited", &undisturbed);
}

#[test]
fn a_folder_that_became_read_only_is_named() {
    let (question, undisturbed) = asked();
    let Some(disk) = Disk::new(question.path("disk"), 65536) else {
        return eprintln!("skipped: this process may not mount a disk");
    };
    let mut child = begun(&question, "disk/run");
    wait_for(&mut child, &question.path("disk/run/checkpoints"));
    child.kill().unwrap();
    child.wait().unwrap();
    disk.remount("ro");
    let output = question.command(&program(), "disk/run", &["--resume"]).output().unwrap();
    refused(&output, "disk/run", &["Read-only file system"]);
    let output = question.command(&program(), "disk/other", &[]).output().unwrap();
    refused(&output, "disk/other", &["Read-only file system"]);
    disk.remount("rw");
    resumed(&question, &program(), "disk/run", &undisturbed);
}

#[test]
fn a_failing_write_flush_or_rename_is_named_and_loses_nothing() {
    if !can_trace() {
        return eprintln!("skipped: there is no strace, or it may not trace");
    }
    let outcome = sweep(&Question::new("gru"), &program(), 6);
    assert!(outcome.runs > 6 && outcome.sound == outcome.runs, "{:#?}", outcome.faults);
}

/// Whoever reads the output may go away at any time: the run comes to its end all the same.
#[test]
fn a_closed_pipe_stops_nothing() {
    let (question, undisturbed) = asked();
    let mut child =
        question.command(&program(), "piped", &[]).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    drop((child.stdout.take(), child.stderr.take()));
    assert_eq!(child.wait().unwrap().code(), Some(0));
    resumed(&question, &program(), "piped", &undisturbed);
}

/// The table on a full disk is lost, unlike the records: that is said.
#[test]
fn a_table_that_cannot_be_printed_is_an_error() {
    let Ok(full) = File::options().write(true).open("/dev/full") else { return eprintln!("skipped: no /dev/full") };
    let (question, undisturbed) = asked();
    let output = question.command(&program(), "full", &[]).stdout(full).output().unwrap();
    refused(&output, "standard output", &["No space left on device"]);
    resumed(&question, &program(), "full", &undisturbed);
}

#[test]
fn the_second_ctrl_c_ends_a_run_at_once_and_it_can_be_resumed() {
    let (question, undisturbed) = asked();
    // A run may have ended before the signals come.
    let stopped = (0..50).find(|attempt| {
        let out = format!("twice-{attempt}");
        let mut child = begun(&question, &out);
        wait_for(&mut child, &question.path(&out).join("nominal.json"));
        // One process sends both, so that they come as quickly as they can.
        let signals = format!("kill -INT {0}; kill -INT {0}", child.id());
        drop(Command::new("sh").args(["-c", &signals]).stderr(Stdio::null()).status());
        match child.wait().unwrap().code() {
            Some(0) => false,
            code => {
                assert_eq!(code, Some(130));
                true
            }
        }
    });
    resumed(&question, &program(), &format!("twice-{}", stopped.unwrap()), &undisturbed);
}

/// No decision depends on when a file was written.
#[test]
fn a_clock_that_jumps_changes_nothing() {
    let (question, undisturbed) = asked();
    for (out, years) in [("future", 60), ("past", -40)] {
        let mut child = begun(&question, out);
        wait_for(&mut child, &question.path(out).join("checkpoints/final-seed1.safetensors"));
        child.kill().unwrap();
        child.wait().unwrap();
        age(&question.path(out), years);
        resumed(&question, &program(), out, &undisturbed);
        age(&question.path(out), -years);
        resumed(&question, &program(), out, &undisturbed);
    }
}

#[test]
fn a_terminal_of_no_width_or_none_at_all_is_as_good() {
    let (question, undisturbed) = asked();
    let run = question.command(&program(), "narrow", &[]);
    let quoted: Vec<String> = std::iter::once(run.get_program())
        .chain(run.get_args())
        .map(|word| format!("'{}'", word.to_string_lossy()))
        .collect();
    let line = format!("stty cols 0 rows 0; {}", quoted.join(" "));
    let mut script = Command::new("script");
    let output = script.args(["-qec", &line, "/dev/null"]).current_dir(question.path("")).stdin(Stdio::null()).output();
    match output {
        Err(_) => eprintln!("skipped in part: there is no `script` to make a terminal"),
        Ok(output) => {
            assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
            resumed(&question, &program(), "narrow", &undisturbed);
        }
    }
    let run = question.command(&program(), "without", &[]);
    let mut shell = Command::new("sh");
    shell.args(["-c", "exec \"$0\" \"$@\" <&- >&- 2>&-"]).arg(run.get_program()).args(run.get_args());
    assert!(shell.current_dir(question.path("")).status().unwrap().success());
    resumed(&question, &program(), "without", &undisturbed);
}

/// A reader accepts what was renamed before the machine stopped, and what was not yet is begun again.
#[test]
fn drafts_of_a_machine_that_stopped_are_swept_away() {
    let (question, undisturbed) = asked();
    let ended = question.command(&program(), "swept", &[]).output().unwrap();
    assert!(ended.status.success());
    for folder in ["", "records", "predictions", "checkpoints"] {
        fs::write(question.path("swept").join(folder).join(".writing-abc"), "half").unwrap();
    }
    fs::remove_file(question.path("swept/records/final-seed2.json")).unwrap();
    resumed(&question, &program(), "swept", &undisturbed);
}

/// Files of ten gigabytes that lie on no disk, a pipe that nobody writes to: refused by their names, in little memory.
#[test]
fn files_that_cannot_be_right_are_refused_unread() {
    let (question, undisturbed) = asked();
    assert!(question.command(&program(), "huge", &[]).output().unwrap().status.success());
    let [record, checkpoint, table] =
        ["records/final-seed2.json", "checkpoints/final-seed2.safetensors", "predictions/final-seed2.parquet"]
            .map(|name| question.path("huge").join(name));
    let refused = |file: &Path| {
        let run = question.command(&program(), "huge", &["--resume"]);
        let mut shell = Command::new("sh");
        shell.args(["-c", "ulimit -v 8000000; exec \"$0\" \"$@\""]).arg(run.get_program()).args(run.get_args());
        let output = shell.current_dir(question.path("")).output().unwrap();
        refused(&output, &file.file_name().unwrap().to_string_lossy(), &["10737418240 bytes", "SHA-256", "not a file"]);
    };
    for file in [&table, &record] {
        let good = fs::read(file).unwrap();
        fs::remove_file(file).unwrap();
        assert!(Command::new("mkfifo").arg(file).status().unwrap().success());
        refused(file);
        fs::remove_file(file).unwrap();
        fs::write(file, good).unwrap();
    }
    // Without its record, a run is read from its checkpoint.
    for file in [&record, &checkpoint] {
        File::create(file).unwrap().set_len(10 << 30).unwrap();
        refused(file);
        fs::remove_file(file).unwrap();
    }
    // A header that says it is ten gigabytes long.
    fs::write(&checkpoint, [&10_000_000_000_u64.to_le_bytes()[..], b"{}"].concat()).unwrap();
    let output = question.command(&program(), "huge", &["--resume"]).output().unwrap();
    disks::refused(&output, "final-seed2.safetensors", &["damaged"]);
    fs::remove_file(&checkpoint).unwrap();
    resumed(&question, &program(), "huge", &undisturbed);
}
