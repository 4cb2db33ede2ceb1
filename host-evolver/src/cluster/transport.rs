//! How processes reach each other.

use std::thread;
use std::time::Duration;

/// What performs a job: its bytes become those of its result. Called on threads of a pool, several at a time.
pub type Perform<'p> = dyn Fn(&[u8]) -> Vec<u8> + Sync + 'p;

/// Carries messages between the ranks of a job, 0, 1, …: whole, and those from one rank to another in their order. It stays on the
/// thread that made it.
pub trait Transport {
    /// The rank of this process.
    fn rank(&self) -> usize;

    /// How many ranks there are.
    fn size(&self) -> usize;

    /// The machine that this process runs on, for people.
    fn machine(&self) -> String;

    /// How many threads this process may well have, at least one, so that all ranks on its machine together have one for each core.
    fn threads(&self) -> usize;

    /// The next message and the rank that sent it, if one has arrived.
    fn receive(&self) -> Option<(usize, Vec<u8>)>;

    /// Sends a message. May wait until the other one receives.
    fn send(&self, to: usize, message: &[u8]);
}

/// Sleeps between looks at something, short at first and longer when nothing comes.
pub struct Patience {
    pause: Duration,
    longest: Duration,
}

impl Patience {
    /// The first pause.
    const FIRST: Duration = Duration::from_micros(250);

    /// Pauses of at most `longest`.
    pub fn up_to(longest: Duration) -> Patience {
        Patience { pause: Patience::FIRST, longest }
    }

    /// The next pause.
    pub fn next(&mut self) -> Duration {
        let pause = self.pause;
        self.pause = (2 * pause).min(self.longest);
        pause
    }

    /// Begins with short pauses again.
    pub fn renew(&mut self) {
        self.pause = Patience::FIRST;
    }
}

/// Longest time between two looks for a message that is expected.
const GLANCE: Duration = Duration::from_millis(4);

/// Waits for the next message.
pub fn expect(transport: &dyn Transport) -> (usize, Vec<u8>) {
    let mut patience = Patience::up_to(GLANCE);
    loop {
        match transport.receive() {
            Some(letter) => return letter,
            None => thread::sleep(patience.next()),
        }
    }
}
