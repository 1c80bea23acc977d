//! Bounded reads: a file that claims more than a plausible length is refused before memory is allocated.

use std::{
    io::{self, Read},
    path::Path,
};

pub use acm_datasets::files::regular::open;

/// Returns the bytes of a file of at most `most` bytes.
///
/// # Errors
/// As [`open`]; the file is longer.
pub fn read(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let refuse = |what: String| Err(io::Error::new(io::ErrorKind::InvalidData, what));
    let file = open(path)?;
    let length = file.metadata()?.len();
    if length > most {
        return refuse(format!("it has {length} bytes, and at most {most} can be right"));
    }
    let mut bytes = Vec::with_capacity(length as usize);
    file.take(most + 1).read_to_end(&mut bytes)?;
    match bytes.len() as u64 > most {
        true => refuse(format!("it grows, and has more than {most} bytes")),
        false => Ok(bytes),
    }
}

#[cfg(test)]
mod tests {
    use std::fs::{self, File};

    use super::*;

    #[test]
    fn a_file_is_read_up_to_its_limit_and_not_beyond() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        fs::write(&path, [7; 10]).unwrap();
        assert_eq!(read(&path, 10).unwrap(), [7; 10]);
        assert!(read(&path, 9).unwrap_err().to_string().contains("10 bytes"));
        assert!(read(folder.path(), 9).unwrap_err().to_string().contains("not a file"));
    }

    /// Ten gigabytes that lie in no memory: the file is sparse.
    #[test]
    fn ten_gigabytes_are_refused_unread() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        File::create(&path).unwrap().set_len(10 << 30).unwrap();
        assert!(read(&path, 1 << 20).unwrap_err().to_string().contains("10737418240 bytes"));
    }
}
