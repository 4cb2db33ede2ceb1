//! Who makes a campaign's tasks: the threads of this process, and those of others if it leads any.

use super::listener::Listener;
use super::task::{Maker, Product, Refusal, Task};
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

/// What goes with all tasks of a campaign.
pub struct Site<'s> {
    /// The campaign's folder.
    pub folder: &'s Path,
    /// Makes its tasks.
    pub maker: &'s Maker<'s>,
    /// Whether it is to stop.
    pub stop: &'s AtomicBool,
    /// Who hears of it.
    pub listener: &'s dyn Listener,
}

/// Tasks by their numbers, long ones best first.
pub struct Tasks<'t> {
    /// How many there are.
    pub count: usize,
    /// One of them.
    pub task: &'t (dyn Fn(usize) -> Task + Sync),
}

/// Takes what came of a task.
pub type Put<'t> = dyn Fn(usize, Result<Product, Refusal>) -> Result<(), FileError> + Sync + 't;

/// A result on its way; nothing of a task that was stopped.
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

    /// Makes all tasks, in any order, and hands to `put` what comes of each. Those that `stop` has ended or kept from being begun are
    /// not handed over.
    ///
    /// # Errors
    /// The first that `put` says; no further task is begun then.
    pub fn make(&mut self, site: &Site<'_>, tasks: &Tasks<'_>, put: &Put<'_>) -> Result<(), FileError> {
        let &Site { maker, stop, .. } = site;
        match &mut self.leader {
            Some(leader) => lead(leader, &self.pool, site, tasks, put),
            None => self.pool.install(|| {
                (0..tasks.count).into_par_iter().with_max_len(1).try_for_each(|number| {
                    if stop.load(Ordering::Relaxed) {
                        return Ok(());
                    }
                    let made = maker.make(&(tasks.task)(number), stop).transpose();
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
    tasks: &Tasks<'_>,
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
    let jobs = Jobs { count: tasks.count, job: &|number| written(&(tasks.task)(number)) };
    let worked = leader.work(&jobs, pool, &|task: &[u8]| perform(maker, task, stop), stop, &mut done);
    outcome?;
    worked.map_err(|error| FileError::internal(folder, error))
}

/// Makes tasks of the leader's for as long as it wants. Nothing is read from the campaign's folder, and nothing written.
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
    let served = follower.serve(pool, &|task: &[u8]| perform(maker, task, stop), stop);
    served.map_err(|error| FileError::internal(file, error))
}

/// The bytes of a task become those of what was made.
fn perform(maker: &Maker<'_>, task: &[u8], stop: &AtomicBool) -> Vec<u8> {
    let task = postcard::from_bytes(task).map_err(Refusal::internal);
    let made: Made = task.and_then(|task: Task| maker.make(&task, stop));
    written(&made)
}

fn written(value: &impl serde::Serialize) -> Vec<u8> {
    // Plain structures in memory always have a form.
    postcard::to_allocvec(value).unwrap_or_default()
}
