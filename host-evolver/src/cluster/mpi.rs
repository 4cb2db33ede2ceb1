//! Messages by MPI.

use super::transport::{Patience, Transport};
use ::mpi::environment::{Universe, processor_name};
use ::mpi::topology::SimpleCommunicator;
use ::mpi::traits::{Communicator, CommunicatorCollectives, Destination, MatchedReceiveVec, Source};
use ::mpi::{Rank, Threading};
use std::thread;
use std::time::Duration;

/// Longest time between two looks whether a message has been taken.
const GLANCE: Duration = Duration::from_millis(4);
/// How a process ends that has panicked, as without MPI.
const PANICKED: i32 = 101;

/// All processes that were started together.
pub struct Mpi {
    world: SimpleCommunicator,
    threads: usize,
    /// MPI ends with it, so it comes last.
    _universe: Universe,
}

/// Starts MPI in this process. `None` if it does not start.
pub fn start() -> Option<Mpi> {
    let (universe, _) = ::mpi::initialize_with_threading(Threading::Funneled)?;
    let world = universe.world();
    let threads = share_of_cores(&world);
    Some(Mpi { world, threads, _universe: universe })
}

impl Transport for Mpi {
    fn rank(&self) -> usize {
        self.world.rank() as usize
    }

    fn size(&self) -> usize {
        self.world.size() as usize
    }

    fn machine(&self) -> String {
        processor_name().unwrap_or_default()
    }

    fn threads(&self) -> usize {
        self.threads
    }

    fn receive(&self) -> Option<(usize, Vec<u8>)> {
        let (bytes, status) = self.world.any_process().immediate_matched_probe()?.matched_receive_vec::<u8>();
        Some((status.source_rank() as usize, bytes))
    }

    fn send(&self, to: usize, message: &[u8]) {
        let mut patience = Patience::up_to(GLANCE);
        ::mpi::request::scope(|scope| {
            let mut request = self.world.process_at_rank(to as Rank).immediate_send(scope, message);
            while let Err(unfinished) = request.test() {
                request = unfinished;
                thread::sleep(patience.next());
            }
        });
    }
}

impl Drop for Mpi {
    /// A process that panics ends all of them: to finish MPI in order it would have to wait for the others.
    fn drop(&mut self) {
        if thread::panicking() {
            self.world.abort(PANICKED);
        }
    }
}

/// Cores that the system tells apart, as bytes of a set.
const CORES: usize = 1024;

/// This process's share of the cores that it may run on: each core is shared by the ranks of the machine that may use it. Whole
/// cores, at least one.
fn share_of_cores(world: &SimpleCommunicator) -> usize {
    let machine = world.split_shared(world.rank());
    let mine = usable_cores();
    let mut all = vec![0_u8; CORES * machine.size() as usize];
    machine.all_gather_into(&mine[..], &mut all[..]);
    let users = |core: usize| all.iter().skip(core).step_by(CORES).filter(|&&usable| usable == 1).count();
    let share: f64 = (0..CORES).filter(|&core| mine[core] == 1).map(|core| 1.0 / users(core) as f64).sum();
    // Shares such as three thirds are a whole.
    let allowed = thread::available_parallelism().map_or(1, usize::from);
    ((share + 1e-6) as usize).clamp(1, allowed)
}

/// 1 for each core that this process may run on; where the system does not tell which, the first so many.
fn usable_cores() -> [u8; CORES] {
    let mut usable = [0; CORES];
    #[cfg(target_os = "linux")]
    if let Ok(set) = rustix::thread::sched_getaffinity(None) {
        (0..CORES).for_each(|core| usable[core] = u8::from(set.is_set(core)));
        return usable;
    }
    let count = thread::available_parallelism().map_or(1, usize::from);
    usable.iter_mut().take(count).for_each(|core| *core = 1);
    usable
}
