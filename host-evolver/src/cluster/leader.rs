//! The process that has the work.

use super::ClusterError;
use super::message::{Answer, Hello, Report, Then, read, write};
use super::transport::{Patience, Perform, Transport, expect};
use rayon::ThreadPool;
use std::panic::{self, AssertUnwindSafe};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc;
use std::time::Duration;

/// Longest time between two looks for reports.
const GLANCE: Duration = Duration::from_millis(4);

/// The leader's end of a cluster. Dropped, it lets the followers go.
pub struct Leader {
    transport: Box<dyn Transport>,
    /// Followers that wait for an answer.
    unanswered: Vec<usize>,
}

/// Jobs by their numbers from 0, the long ones best first.
pub struct Jobs<'j> {
    /// How many there are.
    pub count: usize,
    /// The bytes of one.
    pub job: &'j dyn Fn(usize) -> Vec<u8>,
}

impl Leader {
    /// The leader among the ranks of a transport: rank 0.
    pub fn new(transport: Box<dyn Transport>) -> Leader {
        Leader { transport, unanswered: Vec::new() }
    }

    /// How many threads this process may well have.
    pub fn threads(&self) -> usize {
        self.transport.threads()
    }

    /// How many followers there are.
    pub fn followers(&self) -> usize {
        self.transport.size() - 1
    }

    /// Waits until all followers are there. All must see what decides results as this process does.
    ///
    /// # Errors
    /// A follower that cannot take part, or that sees it otherwise: that with the lowest rank.
    pub fn gather(&mut self, identity: &str) -> Result<(), ClusterError> {
        let mut faults = Vec::new();
        for _ in 0..self.followers() {
            let (rank, bytes) = expect(&*self.transport);
            self.unanswered.push(rank);
            match read::<Hello>(&bytes) {
                None => faults.push((rank, ClusterError::Garbled { rank })),
                Some(Hello { machine, identity: Err(reason) }) => {
                    faults.push((rank, ClusterError::Unfit { rank, machine, reason }));
                }
                Some(Hello { machine, identity: Ok(theirs) }) if theirs != identity => {
                    let reason =
                        "has another grn, other files or other options than rank 0; every machine must have the same";
                    faults.push((rank, ClusterError::Unfit { rank, machine, reason: reason.into() }));
                }
                Some(_) => {}
            }
        }
        match faults.into_iter().min_by_key(|(rank, _)| *rank) {
            Some((_, fault)) => Err(fault),
            None => {
                self.answer_all(Then::Go);
                Ok(())
            }
        }
    }

    fn answer_all(&mut self, then: Then) {
        for rank in std::mem::take(&mut self.unanswered) {
            self.transport.send(rank, &write(&Answer::only(then)));
        }
    }

    /// Has all jobs performed, by the followers and by `perform` on `pool`, and hands each result with the number of its job to
    /// `done`, on this thread. Where `done` says no, or once `stop` is set here or at a follower, no further job is begun, and those
    /// under way are waited for; `stop` is then set everywhere, and whoever performs is expected to look at it.
    ///
    /// # Errors
    /// A follower that sends what cannot be read.
    pub fn work(
        &mut self,
        jobs: &Jobs<'_>,
        pool: &ThreadPool,
        perform: &Perform<'_>,
        stop: &AtomicBool,
        done: &mut dyn FnMut(usize, Vec<u8>) -> bool,
    ) -> Result<(), ClusterError> {
        let (sender, finished) = mpsc::channel();
        let mut course = Course { count: jobs.count, next: 0, under_way: 0, goes_on: true };
        let mut own = 0;
        let mut patience = Patience::up_to(GLANCE);
        pool.in_place_scope(|scope| {
            while course.is_unfinished() {
                course.goes_on &= !stop.load(Ordering::Relaxed);
                let mut is_idle = true;
                while let Some((rank, bytes)) = self.transport.receive() {
                    is_idle = false;
                    let report: Report = read(&bytes).ok_or(ClusterError::Garbled { rank })?;
                    course.take(report.results, done);
                    if report.is_stopped {
                        stop.store(true, Ordering::Relaxed);
                        course.goes_on = false;
                    }
                    let number = if report.is_free { course.begin() } else { None };
                    let job = number.map(|number| (number, (jobs.job)(number)));
                    let then = if stop.load(Ordering::Relaxed) { Then::Stop } else { Then::Go };
                    self.transport.send(rank, &write(&Answer { job, then }));
                }
                // One at a time between reports: with few jobs every rank gets its share.
                if let Some(number) = (own < pool.current_num_threads()).then(|| course.begin()).flatten() {
                    is_idle = false;
                    own += 1;
                    let (sender, job) = (sender.clone(), (jobs.job)(number));
                    scope.spawn(move |_| {
                        let result = panic::catch_unwind(AssertUnwindSafe(|| perform(&job)));
                        // Nobody listens any more only after a panic.
                        let _ = sender.send((number, result));
                    });
                }
                let pause = if is_idle { patience.next() } else { Duration::ZERO };
                if let Ok((number, result)) = finished.recv_timeout(pause) {
                    is_idle = false;
                    own -= 1;
                    let result = result.unwrap_or_else(|panic| panic::resume_unwind(panic));
                    course.take(vec![(number, result)], done);
                }
                if !is_idle {
                    patience.renew();
                }
            }
            Ok(())
        })
    }
}

/// How far the jobs have come.
struct Course {
    count: usize,
    next: usize,
    under_way: usize,
    goes_on: bool,
}

impl Course {
    fn is_unfinished(&self) -> bool {
        self.under_way > 0 || (self.goes_on && self.next < self.count)
    }

    /// The number of the job that is to be begun now, if one is.
    fn begin(&mut self) -> Option<usize> {
        let number = (self.goes_on && self.next < self.count).then_some(self.next)?;
        self.next += 1;
        self.under_way += 1;
        Some(number)
    }

    fn take(&mut self, results: Vec<(usize, Vec<u8>)>, done: &mut dyn FnMut(usize, Vec<u8>) -> bool) {
        for (number, result) in results {
            self.under_way -= 1;
            self.goes_on &= done(number, result);
        }
    }
}

impl Drop for Leader {
    /// Every follower reports sooner or later, and is then told to leave. After a panic the transport ends them.
    fn drop(&mut self) {
        if std::thread::panicking() {
            return;
        }
        let mut left = self.followers() - self.unanswered.len();
        self.answer_all(Then::Leave);
        while left > 0 {
            let (rank, _) = expect(&*self.transport);
            self.transport.send(rank, &write(&Answer::only(Then::Leave)));
            left -= 1;
        }
    }
}
