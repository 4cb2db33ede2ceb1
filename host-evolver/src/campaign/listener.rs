//! Who hears how a campaign goes.

/// Hears how a campaign goes.
pub trait Listener: Sync {
    /// A unit was there already; it is worth this many evaluations of f2.
    fn found(&self, evaluations: u64);
    /// A unit is done; it cost this many evaluations of f2.
    fn done(&self, evaluations: u64);
    /// Something that the user should know.
    fn notice(&self, text: &str);
}
