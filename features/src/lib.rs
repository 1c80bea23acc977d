//! Empty: its manifest is what matters. See there.
