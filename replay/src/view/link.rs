//! The way to a running viewer: messages that it does not take in time are dropped, and nobody waits for it.
//!
//! Rerun's own sink for it waits with its sender when a hundred messages are under way, tries for ever once it
//! has been told to end, and does not connect again (0.36.3, read in its source).

use std::io;
use std::pin::Pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, AtomicU64, Ordering};
use std::sync::mpsc as threads;
use std::task::{Context, Poll, ready};
use std::thread;
use std::time::Duration;

use re_protos::sdk_comms::v1alpha1::message_proxy_service_client::MessageProxyServiceClient;
use re_protos::sdk_comms::v1alpha1::{ReadTablesRequest, WriteMessagesRequest};
use rerun::external::re_log_encoding::ToTransport;
use rerun::external::re_log_encoding::rrd::Compression;
use rerun::external::re_log_types::LogMsg;
use rerun::sink::{LogSink, SinkFlushError};
use tokio::sync::mpsc;
use tonic::codegen::tokio_stream::Stream;
use tonic::transport::Endpoint;

/// Messages under way at most: some seconds of a flight.
const QUEUE: usize = 4096;
/// A row is drawn when there is room for so many: it has fewer.
const ROOM: usize = 512;
/// A viewer that is there has taken the connection by then.
const CONNECTS: Duration = Duration::from_millis(500);
/// And answered.
const ANSWERS: Duration = Duration::from_secs(2);
/// A connection over which nothing was heard for so long is asked whether it still is one.
const SILENT: Duration = Duration::from_secs(5);
/// And given up when there is no answer by then: a viewer that is stopped for a while stays.
const GIVEN_UP: Duration = Duration::from_secs(20);

/// How far a link is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standing {
    /// No answer yet.
    Opening,
    /// Messages go out.
    Open,
    /// There was no viewer, or there is none any more.
    Gone,
}

/// What both threads know.
#[derive(Default)]
struct Shared {
    standing: AtomicU8,
    dropped: AtomicU64,
}

const OPEN: u8 = 1;
const GONE: u8 = 2;

/// One connection, or the attempt.
pub struct Link {
    queue: mpsc::Sender<LogMsg>,
    shared: Arc<Shared>,
    arrived: threads::Receiver<bool>,
}

impl Link {
    /// Begins to open one; its thread ends with it.
    pub fn open(place: &str) -> io::Result<Self> {
        let (queue, messages) = mpsc::channel(QUEUE);
        let (done, arrived) = threads::channel();
        let shared = Arc::new(Shared::default());
        let (place, known) = (place.to_string(), Arc::clone(&shared));
        thread::Builder::new().name("to-viewer".into()).spawn(move || {
            let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
            // Whatever went wrong: there is no viewer there.
            let delivered = runtime
                .is_ok_and(|runtime| runtime.block_on(deliver(&place, messages, &known)).is_ok());
            known.standing.store(GONE, Ordering::Release);
            let _ = done.send(delivered);
        })?;
        Ok(Self { queue, shared, arrived })
    }

    /// How far it is.
    pub fn standing(&self) -> Standing {
        match self.shared.standing.load(Ordering::Acquire) {
            OPEN => Standing::Open,
            GONE => Standing::Gone,
            _ => Standing::Opening,
        }
    }

    /// Whether there is room for a row.
    pub fn has_room(&self) -> bool {
        self.queue.capacity() >= ROOM
    }

    /// Messages that found no room.
    pub fn dropped(&self) -> u64 {
        self.shared.dropped.load(Ordering::Relaxed)
    }

    /// Where a recording goes.
    pub fn sink(&self) -> Box<dyn LogSink> {
        Box::new(Post { queue: self.queue.clone(), shared: Arc::clone(&self.shared) })
    }

    /// Waits until everything has arrived, when all sinks are gone; whether it has in time.
    pub fn close(self, patience: Duration) -> bool {
        let Self { queue, shared: _, arrived } = self;
        drop(queue);
        arrived.recv_timeout(patience).unwrap_or(false)
    }
}

/// Puts messages into the queue.
struct Post {
    queue: mpsc::Sender<LogMsg>,
    shared: Arc<Shared>,
}

impl LogSink for Post {
    fn send(&self, message: LogMsg) {
        if self.queue.try_send(message).is_err() {
            self.shared.dropped.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// Nobody waits.
    fn flush_blocking(&self, _: Duration) -> Result<(), SinkFlushError> {
        Ok(())
    }
}

/// Messages as they go out.
struct Outgoing {
    messages: mpsc::Receiver<LogMsg>,
}

impl Stream for Outgoing {
    type Item = WriteMessagesRequest;

    fn poll_next(mut self: Pin<&mut Self>, context: &mut Context) -> Poll<Option<Self::Item>> {
        loop {
            let Some(message) = ready!(self.messages.poll_recv(context)) else {
                return Poll::Ready(None);
            };
            // One that cannot be encoded cannot be sent.
            if let Ok(message) = message.to_transport(Compression::LZ4) {
                let log_msg = Some(message.into());
                return Poll::Ready(Some(WriteMessagesRequest { log_msg }));
            }
        }
    }
}

/// Why nothing goes out.
#[derive(Debug, thiserror::Error)]
enum Undelivered {
    #[error(transparent)]
    Connection(#[from] tonic::transport::Error),
    #[error("no answer: {0}")]
    Silent(#[from] tokio::time::error::Elapsed),
    #[error(transparent)]
    Refused(Box<tonic::Status>),
}

/// Connects and sends, until there are no more messages or there is no viewer.
async fn deliver(
    place: &str,
    messages: mpsc::Receiver<LogMsg>,
    shared: &Shared,
) -> Result<(), Undelivered> {
    let endpoint = Endpoint::from_shared(format!("http://{place}"))?
        .connect_timeout(CONNECTS)
        .http2_keep_alive_interval(SILENT)
        .keep_alive_timeout(GIVEN_UP)
        .keep_alive_while_idle(true);
    let channel = tokio::time::timeout(ANSWERS, endpoint.connect()).await??;
    let mut viewer = MessageProxyServiceClient::new(channel);
    // What takes connections may be no viewer, or one that stands still: this it answers at once.
    let asked = viewer.read_tables(ReadTablesRequest {});
    let refused = |status| Undelivered::Refused(Box::new(status));
    tokio::time::timeout(ANSWERS, asked).await?.map_err(refused)?;
    shared.standing.store(OPEN, Ordering::Release);
    viewer.write_messages(Outgoing { messages }).await.map(|_| ()).map_err(refused)
}
