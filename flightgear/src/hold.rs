//! The last picture, sent again and again, while nothing new is to be shown.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use crate::link::{Link, Sent};
use crate::picture::Picture;

/// As often as in flight.
const INTERVAL: Duration = Duration::from_millis(4);

/// A picture that is sent until this is stopped or dropped.
#[derive(Debug)]
pub struct Hold {
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<Link>>,
}

impl Hold {
    /// Goes on sending a picture, 250 times a second, on a thread of its own.
    pub fn start(mut link: Link, picture: Picture) -> Self {
        let stop = Arc::new(AtomicBool::new(false));
        let stopping = Arc::clone(&stop);
        let thread = thread::spawn(move || {
            while !stopping.load(Ordering::Relaxed) {
                link.send(&picture);
                thread::sleep(INTERVAL);
            }
            link
        });
        Self { stop, thread: Some(thread) }
    }

    /// Ends it, and gives the link back; `None` if its thread died.
    pub fn stop(mut self) -> Option<Link> {
        self.end()
    }

    /// Ends it: how many pictures went to each place in all.
    pub fn finish(self) -> Vec<Sent> {
        self.stop().map(|link| link.sent()).unwrap_or_default()
    }

    fn end(&mut self) -> Option<Link> {
        self.stop.store(true, Ordering::Relaxed);
        self.thread.take()?.join().ok()
    }
}

impl Drop for Hold {
    fn drop(&mut self) {
        let _ = self.end();
    }
}
