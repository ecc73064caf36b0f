//! Work that takes long, away from the threads that answer the browser: closures go in, what they return comes out.
//!
//! Two run at a time; of those that wait the newest comes first, for it is what is looked at. Whoever drops the future of a
//! job asks it to stop: that is what happens when the browser has gone or wants something newer. A panic is caught and
//! said.

use std::sync::{Arc, Mutex, PoisonError};

use tokio::sync::oneshot;
use tokio::task::spawn_blocking;

use crate::stop::Stop;

/// How many run at a time.
const TOGETHER: usize = 2;

/// Who runs and who waits.
#[derive(Default)]
pub(super) struct Queue {
    state: Arc<Mutex<State>>,
}

#[derive(Default)]
struct State {
    running: usize,
    /// The newest last.
    waiting: Vec<oneshot::Sender<Turn>>,
}

/// Leave to run; whoever waits gets it next.
struct Turn(Option<Arc<Mutex<State>>>);

impl Drop for Turn {
    fn drop(&mut self) {
        let Some(state) = self.0.take() else { return };
        let mut locked = state.lock().unwrap_or_else(PoisonError::into_inner);
        while let Some(waiting) = locked.waiting.pop() {
            match waiting.send(Self(Some(Arc::clone(&state)))) {
                Ok(()) => return,
                // Nobody waits there any more; the leave is still this one.
                Err(mut refused) => refused.0 = None,
            }
        }
        locked.running -= 1;
    }
}

/// Asks for an end when it is dropped.
struct Asking(Stop);

impl Drop for Asking {
    fn drop(&mut self) {
        self.0.ask();
    }
}

impl Queue {
    /// Waits for leave to run.
    async fn turn(&self) -> Turn {
        let waiting = {
            let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
            if state.running < TOGETHER {
                state.running += 1;
                return Turn(Some(Arc::clone(&self.state)));
            }
            let (sender, receiver) = oneshot::channel();
            state.waiting.push(sender);
            receiver
        };
        // A sender is never dropped without being used.
        waiting.await.unwrap_or(Turn(None))
    }

    /// Runs a job, which looks at the [`Stop`] that it is given.
    ///
    /// # Errors
    /// In words, where the job panicked.
    pub(super) async fn run<T: Send + 'static>(
        &self,
        job: impl FnOnce(&Stop) -> T + Send + 'static,
    ) -> Result<T, String> {
        let stop = Stop::new();
        let _asking = Asking(stop.clone());
        let turn = self.turn().await;
        let running = spawn_blocking(move || {
            let _turn = turn;
            job(&stop)
        });
        running.await.map_err(|_| {
            "the program ran into a fault of its own; the preview goes on, and what was drawn last is still there"
                .to_owned()
        })
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc;
    use std::time::Duration;

    use super::*;

    fn runtime() -> tokio::runtime::Runtime {
        tokio::runtime::Builder::new_multi_thread().worker_threads(1).enable_all().build().unwrap()
    }

    #[test]
    fn a_dropped_job_is_asked_to_stop_and_a_panic_is_said() {
        runtime().block_on(async {
            let queue = Queue::default();
            let (sender, ended) = mpsc::channel();
            let endless = queue.run(move |stop: &Stop| {
                while !stop.is_asked() {
                    std::thread::sleep(Duration::from_millis(1));
                }
                sender.send(()).unwrap();
            });
            assert!(tokio::time::timeout(Duration::from_millis(20), endless).await.is_err());
            ended.recv_timeout(Duration::from_secs(20)).unwrap();
            let said = queue.run(|_: &Stop| -> u8 { std::panic::resume_unwind(Box::new("a fault")) }).await;
            assert!(said.unwrap_err().contains("fault"));
            assert_eq!(queue.run(|_: &Stop| 7).await, Ok(7));
        });
    }

    /// How many jobs run or wait.
    fn known(queue: &Queue) -> usize {
        let state = queue.state.lock().unwrap();
        state.running + state.waiting.len()
    }

    #[test]
    fn two_run_at_a_time_and_the_newest_comes_first() {
        runtime().block_on(async {
            let queue = Arc::new(Queue::default());
            let (order, done) = mpsc::channel();
            let mut gates = Vec::new();
            let mut jobs = Vec::new();
            for name in 0..5 {
                let (gate, opened) = mpsc::channel::<()>();
                gates.push(gate);
                let order = order.clone();
                let of = Arc::clone(&queue);
                jobs.push(tokio::spawn(async move {
                    let job = move |_: &Stop| {
                        order.send(name).unwrap();
                        // An error says that the gate is gone: that opens it too.
                        let _ = opened.recv();
                    };
                    of.run(job).await
                }));
                // Each asks before the next does.
                while known(&queue) <= name {
                    tokio::time::sleep(Duration::from_millis(1)).await;
                }
            }
            jobs[3].abort();
            assert!((&mut jobs[3]).await.is_err());
            drop(gates);
            for (name, job) in jobs.into_iter().enumerate().filter(|(name, _)| *name != 3) {
                assert_eq!(job.await.unwrap(), Ok(()), "{name}");
            }
            drop(order);
            let ran: Vec<usize> = done.iter().collect();
            assert_eq!(ran.len(), 4);
            let place = |name| ran.iter().position(|ran| *ran == name).unwrap();
            assert!(place(4) < place(2), "{ran:?}");
        });
    }
}
