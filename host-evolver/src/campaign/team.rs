//! Who makes a campaign's jobs: the threads of this process, and those of others if it leads any.

use super::job::{Job, Maker, Product, Refusal};
use super::listener::Listener;
use crate::cluster::{Follower, Jobs, Leader};
use crate::files::FileError;
use rayon::ThreadPool;
use rayon::prelude::*;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

/// Threads, here and elsewhere.
pub struct Team {
    pool: ThreadPool,
    leader: Option<Leader>,
}

/// What goes with all jobs of a campaign.
pub struct Site<'s> {
    /// The campaign's folder.
    pub folder: &'s Path,
    /// Makes its jobs.
    pub maker: &'s Maker<'s>,
    /// Whether it is to stop.
    pub stop: &'s AtomicBool,
    /// Who hears of it.
    pub listener: &'s dyn Listener,
}

/// Jobs by their numbers, long ones best first.
pub struct Batch<'t> {
    /// How many there are.
    pub count: usize,
    /// One of them.
    pub job: &'t (dyn Fn(usize) -> Job + Sync),
}

/// Takes what came of a job.
pub type Put<'t> = dyn Fn(usize, Result<Product, Refusal>) -> Result<(), FileError> + Sync + 't;

/// A result on its way; nothing of a job that was stopped.
type Made = Result<Option<Product>, Refusal>;

impl Team {
    /// The threads of a pool, and the followers of `leader`.
    pub fn new(pool: ThreadPool, leader: Option<Leader>) -> Team {
        Team { pool, leader }
    }

    /// The threads of this process.
    pub fn pool(&self) -> &ThreadPool {
        &self.pool
    }

    /// Makes all jobs, in any order, and hands to `put` what comes of each. Those that `stop` has ended or kept from being begun are
    /// not handed over.
    ///
    /// # Errors
    /// The first that `put` says; no further job is begun then.
    pub fn make(&mut self, site: &Site<'_>, batch: &Batch<'_>, put: &Put<'_>) -> Result<(), FileError> {
        let &Site { maker, stop, .. } = site;
        match &mut self.leader {
            Some(leader) => lead(leader, &self.pool, site, batch, put),
            None => self.pool.install(|| {
                (0..batch.count).into_par_iter().with_max_len(1).try_for_each(|number| {
                    if stop.load(Ordering::Relaxed) {
                        return Ok(());
                    }
                    let made = maker.make(&(batch.job)(number), stop).transpose();
                    made.map_or(Ok(()), |made| put(number, made))
                })
            }),
        }
    }
}

/// Only this process puts anything in its place.
fn lead(
    leader: &mut Leader,
    pool: &ThreadPool,
    site: &Site<'_>,
    batch: &Batch<'_>,
    put: &Put<'_>,
) -> Result<(), FileError> {
    let &Site { folder, maker, stop, .. } = site;
    let mut outcome = Ok(());
    let mut done = |number: usize, made: Vec<u8>| {
        let made = postcard::from_bytes(&made);
        let made: Made = made.unwrap_or_else(|error| Err(Refusal::internal(error)));
        let put = made.transpose().map_or(Ok(()), |made| put(number, made));
        outcome = std::mem::replace(&mut outcome, Ok(())).and(put);
        outcome.is_ok()
    };
    let jobs = Jobs { count: batch.count, job: &|number| written(&(batch.job)(number)) };
    let worked = leader.work(&jobs, pool, &|job: &[u8]| perform(maker, job, stop), stop, &mut done);
    outcome?;
    worked.map_err(|error| FileError::internal(folder, error))
}

/// Makes jobs of the leader's for as long as it wants. Nothing is read from the campaign's folder, and nothing written.
///
/// # Errors
/// A leader that says what cannot be read, by the campaign's file.
pub fn follow(
    follower: &Follower,
    pool: &ThreadPool,
    maker: &Maker<'_>,
    stop: &AtomicBool,
    file: &Path,
) -> Result<(), FileError> {
    let served = follower.serve(pool, &|job: &[u8]| perform(maker, job, stop), stop);
    served.map_err(|error| FileError::internal(file, error))
}

/// The bytes of a job become those of what was made.
fn perform(maker: &Maker<'_>, job: &[u8], stop: &AtomicBool) -> Vec<u8> {
    let job = postcard::from_bytes(job).map_err(Refusal::internal);
    let made: Made = job.and_then(|job: Job| maker.make(&job, stop));
    written(&made)
}

fn written(value: &impl serde::Serialize) -> Vec<u8> {
    // Plain structures in memory always have a form.
    postcard::to_allocvec(value).unwrap_or_default()
}
