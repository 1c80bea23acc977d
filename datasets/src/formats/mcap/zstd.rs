//! Chunks that are compressed with zstd, by the version of zstd that Parquet uses too.

use ::mcap::sans_io::decompressor::{DecompressResult, Decompressor};
use ::mcap::{McapError, McapResult};
use ::zstd::zstd_safe::{DParameter, DStream, InBuffer, OutBuffer, ResetDirective, SafeResult, get_error_name};

/// Bits of the window that a frame may ask for: 64 MB.
const WINDOW: u32 = 26;

/// Decodes one chunk after the other.
pub(super) struct Zstd {
    stream: DStream<'static>,
    need: usize,
}

impl Zstd {
    pub fn new() -> McapResult<Zstd> {
        let mut stream = DStream::create();
        told(stream.init())?;
        told(stream.set_parameter(DParameter::WindowLogMax(WINDOW)))?;
        Ok(Zstd { stream, need: 0 })
    }
}

fn told(result: SafeResult) -> McapResult<usize> {
    result.map_err(|code| McapError::DecompressionError(get_error_name(code).into()))
}

impl Decompressor for Zstd {
    fn next_read_size(&self) -> usize {
        self.need
    }

    fn decompress(&mut self, from: &[u8], to: &mut [u8]) -> McapResult<DecompressResult> {
        let (mut from, mut to) = (InBuffer::around(from), OutBuffer::around(to));
        self.need = told(self.stream.decompress_stream(&mut to, &mut from))?;
        Ok(DecompressResult { consumed: from.pos, wrote: to.pos() })
    }

    fn reset(&mut self) -> McapResult<()> {
        self.need = 0;
        told(self.stream.reset(ResetDirective::SessionOnly)).map(drop)
    }

    fn name(&self) -> &'static str {
        "zstd"
    }
}
