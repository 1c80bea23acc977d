//! Disks that are full, read-only or limited, and files from another time.

use std::{
    fs::File,
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
    time::{Duration, SystemTime},
};

use crate::faults::{kills::Undisturbed, questions::Question};

/// A file system in memory, of a size of its own; taken away when dropped.
pub struct Disk {
    /// Where it is mounted.
    pub path: PathBuf,
}

impl Disk {
    /// Of so many kilobytes, mounted at an empty folder; none where this process may not mount.
    pub fn new(path: PathBuf, kilobytes: usize) -> Option<Self> {
        std::fs::create_dir_all(&path).unwrap();
        let size = format!("size={kilobytes}k");
        let mut mount = Command::new("mount");
        mount.args(["-t", "tmpfs", "-o", &size, "tmpfs"]).arg(&path).stderr(Stdio::null());
        mount.status().is_ok_and(|status| status.success()).then_some(Self { path })
    }

    /// With other options: `size=64m`, `ro`, `rw`.
    pub fn remount(&self, options: &str) {
        let options = format!("remount,{options}");
        assert!(Command::new("mount").args(["-o", &options]).arg(&self.path).status().unwrap().success());
    }
}

impl Drop for Disk {
    fn drop(&mut self) {
        drop(Command::new("umount").arg("-l").arg(&self.path).status());
    }
}

/// Code 4 and a message with the folder.
#[track_caller]
pub fn refused(output: &Output, folder: &str, reasons: &[&str]) {
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(4), "{told}");
    assert!(told.contains(folder) && reasons.iter().any(|reason| told.contains(reason)), "{told}");
    assert!(!told.contains("panicked"), "{told}");
}

/// Resumes to the end, where the bits are to be those of the undisturbed run.
#[track_caller]
pub fn resumed(question: &Question, program: &Path, out: &str, undisturbed: &Undisturbed) {
    let ended = question.command(program, out, &["--resume"]).output().unwrap();
    assert!(ended.status.success(), "{}", String::from_utf8_lossy(&ended.stderr));
    let same = undisturbed.compare(question, out, &String::from_utf8_lossy(&ended.stdout));
    assert!(same.is_ok(), "{same:?}");
}

/// Gives every file below a folder a time stamp in years from now; before now where negative.
pub fn age(folder: &Path, years: i64) {
    let shift = Duration::from_secs(years.unsigned_abs() * 31_557_600);
    let now = SystemTime::now();
    let time = if years < 0 { now.checked_sub(shift) } else { now.checked_add(shift) }.unwrap();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        match path.is_dir() {
            true => age(&path, years),
            false => File::options().write(true).open(&path).and_then(|file| file.set_modified(time)).unwrap(),
        }
    }
}
