//! Locks on folders: the operating system releases them when the process ends.
//!
//! The lock file also says who holds it, for the message of those who come second. Nothing is decided by what it says.

use std::{
    fs::{self, File, TryLockError},
    io::{self, Read, Seek, SeekFrom, Write},
    path::Path,
    thread::sleep,
    time::Duration,
};

use indicatif::HumanDuration;

/// A holder that has just come needs a moment until it has written who it is.
const MOMENT: Duration = Duration::from_millis(50);
/// More than any note of a holder.
const LONGEST: u64 = 300;

/// Number of retries of a waiting caller, and their interval.
const TRIES: usize = 100;
const AGAIN: Duration = Duration::from_millis(100);

/// A lock that is held. Dropping it releases it.
#[derive(Debug)]
pub struct Lock {
    file: File,
}

/// Why a lock was not taken.
#[derive(Debug)]
pub enum Refused {
    /// Somebody holds it: `process 4711 on lab3, for 2 hours`.
    Held(String),
    /// The file system refuses.
    Io(io::Error),
}

/// Takes the lock at `path`, which is made where it is missing.
///
/// # Errors
/// Somebody holds it, or the file system refuses.
pub fn take(path: &Path) -> Result<Lock, Refused> {
    let mut file = open(path)?;
    match file.try_lock() {
        Ok(()) => {
            note(&mut file, "").map_err(Refused::Io)?;
            Ok(Lock { file })
        }
        Err(TryLockError::WouldBlock) => Err(Refused::Held(holder(file))),
        Err(TryLockError::Error(source)) => Err(Refused::Io(source)),
    }
}

/// Takes the lock, and waits for up to ten seconds.
///
/// # Errors
/// As [`take()`].
pub fn wait(path: &Path) -> Result<Lock, Refused> {
    patiently(|| take(path))
}

/// Takes it together with others who share it, after ten seconds at most.
///
/// # Errors
/// Somebody holds it alone, or the file system refuses.
pub fn share(path: &Path) -> Result<Lock, Refused> {
    let file = open(path)?;
    patiently(|| match file.try_lock_shared() {
        Ok(()) => Ok(()),
        Err(TryLockError::WouldBlock) => Err(Refused::Held(holder(open(path)?))),
        Err(TryLockError::Error(source)) => Err(Refused::Io(source)),
    })?;
    Ok(Lock { file })
}

/// Whether the lock is held; the file exists, and is not changed.
pub fn is_held(path: &Path) -> bool {
    open(path).is_ok_and(|file| matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock)))
}

impl Lock {
    /// Releases the lock for shared use; the file says so to those who want it exclusively.
    ///
    /// # Errors
    /// The file system refuses.
    pub fn open_up(mut self) -> io::Result<()> {
        note(&mut self.file, ", or by others that share it with that one")
    }
}

fn patiently<T>(attempt: impl Fn() -> Result<T, Refused>) -> Result<T, Refused> {
    for _ in 1..TRIES {
        match attempt() {
            Err(Refused::Held(_)) => sleep(AGAIN),
            other => return other,
        }
    }
    attempt()
}

/// For reading and writing, since a network file system asks for either, by the kind of lock.
fn open(path: &Path) -> Result<File, Refused> {
    File::options().read(true).write(true).create(true).truncate(false).open(path).map_err(Refused::Io)
}

fn note(file: &mut File, others: &str) -> io::Result<()> {
    let text = format!("process {} on {}{others}\n", std::process::id(), host());
    file.set_len(0)?;
    file.seek(SeekFrom::Start(0))?;
    file.write_all(text.as_bytes())
}

fn holder(file: File) -> String {
    sleep(MOMENT);
    let since = file.metadata().and_then(|file| file.modified()).ok().and_then(|noted| noted.elapsed().ok());
    let mut text = String::new();
    // Some systems let nobody read what is locked, and anybody may have written there.
    let read = file.take(LONGEST).read_to_string(&mut text);
    let line = text.lines().next().unwrap_or_default();
    match read.is_ok() && line.starts_with("process ") && !line.chars().any(char::is_control) {
        true => since.map_or(line.into(), |since| format!("{line}, for {}", HumanDuration(since))),
        false => "another process".into(),
    }
}

fn host() -> String {
    let named = ["/proc/sys/kernel/hostname", "/etc/hostname"].iter().find_map(|file| fs::read_to_string(file).ok());
    let named = named.or_else(|| std::env::var("COMPUTERNAME").ok()).unwrap_or_default();
    named.split_whitespace().next().unwrap_or("this host").into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_comes_second_is_told_who_came_first() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(".lock");
        fs::write(&path, "process 1 on a machine that was switched off, with a long name\n").unwrap();
        let first = take(&path).unwrap();
        let Err(Refused::Held(who)) = take(&path) else { panic!("taken twice") };
        let expected = format!("process {} on ", std::process::id());
        assert!(who.starts_with(&expected) && who.contains(", for "), "{who}");
        drop(first);
        take(&path).unwrap();
    }

    #[test]
    fn what_is_no_name_is_not_repeated() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(".lock");
        let _first = take(&path).unwrap();
        for strange in ["", "\u{1b}[2J", "process \u{1b}[2J"] {
            fs::write(&path, strange).unwrap();
            let Err(Refused::Held(who)) = take(&path) else { panic!("taken twice") };
            assert_eq!(who, "another process");
        }
    }
}
