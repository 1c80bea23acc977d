//! Contents of a data file: in memory if small, else on disk.

use std::fs::File;
use std::io::{self, BufReader, Cursor, Read, Seek, SeekFrom};
use std::path::Path;

use sha2::{Digest, Sha256};

use crate::error::DataError;
use crate::files::regular;
use crate::ingest::locate::FILE_LIMIT;

/// Larger Parquet files stay on the disk while they are read.
const HELD: u64 = 1 << 22;

/// Bytes that are hashed at a time.
const CHUNK: usize = 1 << 18;

/// Reads bytes from any place.
pub(crate) trait ReadSeek: Read + Seek {}

impl<T: Read + Seek> ReadSeek for T {}

/// Contents of a file.
pub(crate) enum Content {
    /// All of it.
    Held(Vec<u8>),
    /// An open file and its size.
    OnDisk(File, u64),
}

impl Content {
    /// All of a file.
    pub fn held(path: &Path) -> Result<Self, DataError> {
        checked_size(path)?;
        regular::read(path).map(Self::Held).map_err(|e| DataError::file_system("read", path, &e))
    }

    /// A file that may stay on the disk.
    pub fn of(path: &Path) -> Result<Self, DataError> {
        match checked_size(path)? {
            size if size > HELD => {
                let opened = regular::open(path).map(|file| Self::OnDisk(file, size));
                opened.map_err(|e| DataError::file_system("read", path, &e))
            }
            _ => Self::held(path),
        }
    }

    pub fn size(&self) -> u64 {
        match self {
            Self::Held(bytes) => bytes.len() as u64,
            Self::OnDisk(_, size) => *size,
        }
    }

    /// SHA-256 over all of it.
    pub fn digest(&self) -> io::Result<Vec<u8>> {
        let file = match self {
            Self::Held(bytes) => return Ok(Sha256::digest(bytes).to_vec()),
            Self::OnDisk(file, _) => file,
        };
        let (mut file, mut hash, mut chunk) = (file, Sha256::new(), vec![0; CHUNK]);
        file.seek(SeekFrom::Start(0))?;
        loop {
            match file.read(&mut chunk)? {
                0 => return Ok(hash.finalize().to_vec()),
                count => hash.update(&chunk[..count]),
            }
        }
    }

    /// The first and the last bytes, eight of each where it has so many.
    pub fn ends(&self) -> io::Result<(Vec<u8>, Vec<u8>)> {
        let (mut file, size) = match self {
            Self::Held(bytes) => {
                let few = bytes.len().min(8);
                return Ok((bytes[..few].to_vec(), bytes[bytes.len() - few..].to_vec()));
            }
            Self::OnDisk(file, size) => (file, *size),
        };
        let (mut start, mut end) = (vec![0; size.min(8) as usize], vec![0; size.min(8) as usize]);
        file.seek(SeekFrom::Start(0))?;
        file.read_exact(&mut start)?;
        file.seek(SeekFrom::Start(size - end.len() as u64))?;
        file.read_exact(&mut end)?;
        Ok((start, end))
    }

    /// Returns a reader from the first byte on.
    pub fn reader(&self) -> Box<dyn ReadSeek + '_> {
        match self {
            Self::Held(bytes) => Box::new(Cursor::new(bytes.as_slice())),
            Self::OnDisk(file, _) => Box::new(BufReader::new(file)),
        }
    }
}

fn checked_size(path: &Path) -> Result<u64, DataError> {
    let bytes = std::fs::metadata(path).map_err(|e| DataError::file_system("read", path, &e))?.len();
    if bytes > FILE_LIMIT {
        let remedy = "split the recording into one file per trial";
        return Err(DataError::TooLarge { path: path.to_path_buf(), bytes, limit: FILE_LIMIT, remedy });
    }
    Ok(bytes)
}
