//! A process that does what the leader wants.

use super::ClusterError;
use super::message::{Answer, Hello, Report, Then, read, write};
use super::transport::{Patience, Perform, Transport, expect};
use rayon::ThreadPool;
use std::panic::{self, AssertUnwindSafe};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc;
use std::time::{Duration, Instant};

/// The leader's rank.
const LEADER: usize = 0;
/// Longest time between two reports: a follower that has nothing to tell asks for jobs, and whether to stop.
const SILENCE: Duration = Duration::from_millis(50);

/// A follower's end of a cluster.
pub struct Follower {
    transport: Box<dyn Transport>,
}

impl Follower {
    /// A follower among the ranks of a transport: any but 0.
    pub fn new(transport: Box<dyn Transport>) -> Follower {
        Follower { transport }
    }

    /// How many threads this process may well have.
    pub fn threads(&self) -> usize {
        self.transport.threads()
    }

    /// Tells the leader what decides results as this process sees it, or why it cannot take part. Whether to go on: else the leader
    /// has said why not.
    ///
    /// # Errors
    /// An answer that cannot be read.
    pub fn join(&self, identity: Result<String, String>) -> Result<bool, ClusterError> {
        let hello = Hello { machine: self.transport.machine(), identity };
        Ok(self.ask(&write(&hello))?.then != Then::Leave)
    }

    fn ask(&self, message: &[u8]) -> Result<Answer, ClusterError> {
        self.transport.send(LEADER, message);
        let (rank, bytes) = expect(&*self.transport);
        read(&bytes).ok_or(ClusterError::Garbled { rank })
    }

    /// Performs jobs on `pool`, as many at a time as it has threads, until the leader wants nothing more. Once `stop` is set, here
    /// or by the leader, no further job is begun, and whoever performs is expected to look at it.
    ///
    /// # Errors
    /// An answer that cannot be read.
    pub fn serve(&self, pool: &ThreadPool, perform: &Perform<'_>, stop: &AtomicBool) -> Result<(), ClusterError> {
        let (sender, finished) = mpsc::channel();
        let mut under_way = 0;
        let mut patience = Patience::up_to(SILENCE);
        let mut told = Instant::now();
        pool.in_place_scope(|scope| {
            loop {
                let is_stopped = stop.load(Ordering::Relaxed);
                let is_free = !is_stopped && under_way < pool.current_num_threads();
                let pause = if is_free { patience.next() } else { SILENCE.saturating_sub(told.elapsed()) };
                let mut report = Report { is_free, is_stopped, ..Report::default() };
                let first = finished.recv_timeout(pause).ok();
                for (number, result) in first.into_iter().chain(finished.try_iter()) {
                    under_way -= 1;
                    report.is_free = !is_stopped;
                    let result = std::thread::Result::unwrap_or_else(result, |panic| panic::resume_unwind(panic));
                    report.results.push((number, result));
                }
                let Answer { job, then } = self.ask(&write(&report))?;
                told = Instant::now();
                match then {
                    Then::Go => {}
                    Then::Stop => stop.store(true, Ordering::Relaxed),
                    Then::Leave => return Ok(()),
                }
                if let Some((number, job)) = job {
                    patience.renew();
                    under_way += 1;
                    let sender = sender.clone();
                    scope.spawn(move |_| {
                        let result = panic::catch_unwind(AssertUnwindSafe(|| perform(&job)));
                        // Nobody listens any more only after a panic.
                        let _ = sender.send((number, result));
                    });
                }
            }
        })
    }
}
