//! How bytes come and go, whatever the board.

/// What carries a robot's bytes.
pub trait Port {
    /// Gets ready; bytes that arrive before are lost.
    fn start(&mut self);
    /// Waits for the next byte; `None` if none will ever come.
    fn read(&mut self) -> Option<u8>;
    /// Sends all bytes.
    fn write(&mut self, bytes: &[u8]);
}
