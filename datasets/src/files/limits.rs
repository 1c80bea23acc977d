//! Resource limits: a write past `ulimit -f` returns an error instead of ending the process.

/// From here on such a write is an error; a program calls this first.
#[cfg(unix)]
pub fn ignore_sigxfsz() {
    use std::sync::{Arc, atomic::AtomicBool};
    // The flag itself is not read: a registered handler turns the signal into an error of the write.
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::new(AtomicBool::new(false)));
}

/// Other systems have no such limit.
#[cfg(not(unix))]
pub fn ignore_sigxfsz() {}
