//! What leader and followers say to each other.

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

/// The first message of a follower.
#[derive(Debug, Serialize, Deserialize)]
pub struct Hello {
    /// Its machine.
    pub machine: String,
    /// What decides results as it sees it, or why it cannot take part.
    pub identity: Result<String, String>,
}

/// Every other message of a follower.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct Report {
    /// What came of jobs, by their numbers.
    pub results: Vec<(usize, Vec<u8>)>,
    /// Whether it can begin another job at once.
    pub is_free: bool,
    /// Whether it was asked to stop.
    pub is_stopped: bool,
}

/// What the leader answers to each of them.
#[derive(Debug, Serialize, Deserialize)]
pub struct Answer {
    /// A job with its number.
    pub job: Option<(usize, Vec<u8>)>,
    /// What to do after that.
    pub then: Then,
}

/// What a follower is to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Then {
    /// Go on and report again.
    Go,
    /// Drop the jobs under way, report that, and wait to be told to leave.
    Stop,
    /// Nothing more is wanted.
    Leave,
}

impl Answer {
    /// An answer without a job.
    pub fn only(then: Then) -> Answer {
        Answer { job: None, then }
    }
}

/// The bytes of a message.
pub fn write(message: &impl Serialize) -> Vec<u8> {
    // Plain structures in memory always have a form.
    postcard::to_allocvec(message).unwrap_or_default()
}

/// The message in some bytes, if it is one.
pub fn read<T: DeserializeOwned>(bytes: &[u8]) -> Option<T> {
    postcard::from_bytes(bytes).ok()
}
