//! The exchange between ranks, here threads of one process: what MPI carries elsewhere, channels do.

use super::*;
use rayon::ThreadPoolBuilder;
use std::cell::RefCell;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;
use std::time::Duration;

type Letter = (usize, Vec<u8>);

/// A rank that is a thread.
struct Threaded {
    rank: usize,
    inbox: Receiver<Letter>,
    outboxes: Vec<Sender<Letter>>,
}

impl Transport for Threaded {
    fn rank(&self) -> usize {
        self.rank
    }

    fn size(&self) -> usize {
        self.outboxes.len()
    }

    fn machine(&self) -> String {
        format!("machine {}", self.rank)
    }

    fn threads(&self) -> usize {
        1
    }

    fn receive(&self) -> Option<Letter> {
        self.inbox.try_recv().ok()
    }

    fn send(&self, to: usize, message: &[u8]) {
        self.outboxes[to].send((self.rank, message.to_vec())).unwrap();
    }
}

fn ranks(size: usize) -> Vec<Threaded> {
    let (outboxes, inboxes): (Vec<_>, Vec<_>) = (0..size).map(|_| channel()).unzip();
    let rank = |(rank, inbox)| Threaded { rank, inbox, outboxes: outboxes.clone() };
    inboxes.into_iter().enumerate().map(rank).collect()
}

/// A follower with two threads; how many jobs it has performed.
fn serve(rank: Threaded, perform: &Perform<'_>, stop: &AtomicBool) -> usize {
    let performed = AtomicUsize::new(0);
    let count = |job: &[u8]| {
        performed.fetch_add(1, Ordering::Relaxed);
        perform(job)
    };
    let follower = Follower::new(Box::new(rank));
    assert!(follower.join(Ok("same".into())).unwrap());
    let pool = ThreadPoolBuilder::new().num_threads(2).build().unwrap();
    follower.serve(&pool, &count, stop).unwrap();
    performed.into_inner()
}

/// What `count` jobs give among so many ranks, and how many of them each follower performed. `done` hears of each.
fn worked(
    size: usize,
    count: usize,
    perform: &Perform<'_>,
    stops: &[AtomicBool],
    done: &mut dyn FnMut(usize) -> bool,
) -> (Vec<Option<Vec<u8>>>, Vec<usize>) {
    thread::scope(|scope| {
        let mut ranks = ranks(size).into_iter();
        let mut leader = Leader::new(Box::new(ranks.next().unwrap()));
        let followers: Vec<_> =
            ranks.zip(&stops[1..]).map(|(rank, stop)| scope.spawn(move || serve(rank, perform, stop))).collect();
        leader.gather("same").unwrap();
        let pool = ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let results = RefCell::new(vec![None; count]);
        let jobs = Jobs { count, job: &|number| number.to_string().into_bytes() };
        let mut take = |number: usize, result| {
            assert!(results.borrow_mut()[number].replace(result).is_none(), "job {number} came twice");
            done(number)
        };
        leader.work(&jobs, &pool, perform, &stops[0], &mut take).unwrap();
        drop(leader);
        let performed = followers.into_iter().map(|follower| follower.join().unwrap()).collect();
        (results.into_inner(), performed)
    })
}

fn flags(size: usize) -> Vec<AtomicBool> {
    (0..size).map(|_| AtomicBool::new(false)).collect()
}

fn slowly_doubled(job: &[u8]) -> Vec<u8> {
    thread::sleep(Duration::from_millis(2));
    [job, job].concat()
}

#[test]
fn every_job_is_done_once_by_any_number_of_ranks() {
    let expected: Vec<_> = (0..100).map(|number| Some(format!("{number}{number}").into_bytes())).collect();
    for size in 1..=4 {
        let (results, performed) = worked(size, 100, &slowly_doubled, &flags(size), &mut |_| true);
        assert_eq!(results, expected);
        assert!(performed.iter().all(|&performed| performed > 0), "a follower has stood by: {performed:?}");
    }
    assert_eq!(worked(3, 0, &slowly_doubled, &flags(3), &mut |_| true).0, []);
}

#[test]
fn a_stop_at_any_rank_is_a_stop_at_all_and_what_was_done_is_handed_over() {
    for stopped in 0..3 {
        let stops = flags(3);
        let count = RefCell::new(0);
        let mut done = |_| {
            *count.borrow_mut() += 1;
            if *count.borrow() == 10 {
                stops[stopped].store(true, Ordering::Relaxed);
            }
            true
        };
        let (results, _) = worked(3, 100_000, &slowly_doubled, &stops, &mut done);
        let there = results.iter().flatten().count();
        assert!((10..1000).contains(&there), "{there}");
        assert_eq!(there, *count.borrow());
        assert!(stops.iter().all(|stop| stop.load(Ordering::Relaxed)), "rank {stopped} has stopped alone");
    }
}

#[test]
fn after_a_result_that_cannot_be_kept_nothing_is_begun() {
    let stops = flags(2);
    let (results, _) = worked(2, 1000, &slowly_doubled, &stops, &mut |number| number != 5);
    assert!((6..100).contains(&results.iter().flatten().count()));
    assert!(!stops[0].load(Ordering::Relaxed), "nobody has asked to stop");
}

#[test]
fn a_follower_that_sees_something_else_is_refused_by_name_and_all_may_go() {
    for (theirs, words) in
        [(Ok("other".to_owned()), "has another grn"), (Err("x.toml: is missing".into()), "x.toml: is missing")]
    {
        thread::scope(|scope| {
            let mut ranks = ranks(4).into_iter();
            let mut leader = Leader::new(Box::new(ranks.next().unwrap()));
            let joins = ranks.map(|rank| {
                let identity = if rank.rank == 2 { theirs.clone() } else { Ok("same".into()) };
                scope.spawn(move || Follower::new(Box::new(rank)).join(identity).unwrap())
            });
            let joins: Vec<_> = joins.collect();
            let refused = leader.gather("same").unwrap_err().to_string();
            assert!(refused.starts_with("rank 2 on machine 2: ") && refused.contains(words), "{refused}");
            drop(leader);
            assert!(joins.into_iter().all(|join| !join.join().unwrap()), "somebody goes on");
        });
    }
}

#[test]
fn a_leader_that_gives_up_before_it_begins_lets_the_others_go() {
    let mut ranks = ranks(2);
    let rank = ranks.remove(1);
    let waiting = thread::scope(|scope| {
        let waiting = scope.spawn(move || Follower::new(Box::new(rank)).join(Ok("same".into())).unwrap());
        drop(Leader::new(Box::new(ranks.remove(0))));
        waiting.join().unwrap()
    });
    assert!(!waiting);
}
