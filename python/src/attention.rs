//! Long work that Python attends: it hears the news, and Ctrl-C ends the work in order.

use crate::errors::refused;
use pyo3::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread;
use std::time::Duration;

/// How long Python waits for news before it looks whether Ctrl-C was pressed.
const GLANCE: Duration = Duration::from_millis(100);

/// Does `work` on a thread of its own while other Python threads run. `tell` hears what it sends. Once Ctrl-C was pressed or
/// `tell` has raised something, the work's flag is set, and when it has ended that is raised.
pub fn attended<N: Send, T: Send>(
    py: Python<'_>,
    mut tell: impl FnMut(Python<'_>, N) -> PyResult<()> + Send,
    work: impl FnOnce(&AtomicBool, &Sender<N>) -> T + Send,
) -> PyResult<T> {
    let (news, heard) = mpsc::channel();
    let (done, raised) = py.detach(move || {
        let stop = AtomicBool::new(false);
        thread::scope(|scope| {
            let stop = &stop;
            let worker = scope.spawn(move || work(stop, &news));
            let mut raised = None;
            loop {
                let told = match heard.recv_timeout(GLANCE) {
                    Ok(told) => Some(told),
                    Err(RecvTimeoutError::Timeout) => None,
                    // The work has ended: nobody is left to tell anything.
                    Err(RecvTimeoutError::Disconnected) => return (worker.join(), raised),
                };
                if raised.is_none() {
                    let attend = |py: Python<'_>| {
                        py.check_signals()?;
                        told.map_or(Ok(()), |told| tell(py, told))
                    };
                    raised = Python::attach(attend).err();
                    stop.store(raised.is_some(), Ordering::Relaxed);
                }
            }
        })
    });
    match (done, raised) {
        (_, Some(error)) => Err(error),
        (Ok(done), None) => Ok(done),
        (Err(_), None) => Err(refused("the work ended unexpectedly; this is a defect of grn")),
    }
}
