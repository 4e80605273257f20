//! Blocks of a compacted log flown before their turn, each from the keyframe before it, on other threads.
//!
//! A flight from keyframe to keyframe gives what one flight gives as long as every keyframe is what the
//! stretch before it leads to, and the reader looks at that when the keyframe's turn comes.

use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

use engine::inputs::DeviceEvent;
use engine::{Inputs, State, step, step_state};

use super::block::{Block, Op};
use super::regenerator::{FlightModel, FlownTick, is_kept};
use crate::cdr;
use crate::channels::{Channel, ChannelId, Compacted, compacted};
use crate::records::InputsRecord;

/// Threads that fly blocks.
pub struct BlockWorkers {
    jobs: SyncSender<Job>,
    /// Blocks that may be under way.
    pub blocks: usize,
}

/// States that take the place of those that were flown, each with its number among the messages that stand
/// as they were.
pub type Restarts = Vec<(usize, State)>;

/// A block to be flown.
struct Job {
    from: State,
    block: Arc<Block>,
    restarts: Restarts,
    done: Sender<Vec<FlownTick>>,
}

impl BlockWorkers {
    /// They end when this is dropped.
    pub fn of(threads: usize, flown: &FlightModel) -> Self {
        let blocks = 2 * threads;
        let (jobs, waiting) = sync_channel::<Job>(blocks);
        let (waiting, flown) = (Arc::new(Mutex::new(waiting)), Arc::new(flown.clone()));
        for _ in 0..threads {
            let (waiting, flown) = (Arc::clone(&waiting), Arc::clone(&flown));
            thread::spawn(move || {
                loop {
                    let next = waiting.lock().unwrap_or_else(PoisonError::into_inner).recv();
                    let Ok(Job { from, block, restarts, done }) = next else { break };
                    // Nobody waits for it any more: so be it.
                    let _ = done.send(fly(&flown, from, &block, &restarts));
                }
            });
        }
        Self { jobs, blocks }
    }

    /// Has a block flown from the state before it.
    pub fn fly(
        &self,
        from: State,
        block: &Arc<Block>,
        restarts: Restarts,
    ) -> Option<Receiver<Vec<FlownTick>>> {
        let (done, flown) = channel();
        self.jobs.send(Job { from, block: Arc::clone(block), restarts, done }).ok().map(|()| flown)
    }
}

/// Flies a block by its rows; as far as they can be read, who reads the block says what is wrong.
fn fly(of: &FlightModel, mut state: State, block: &Block, restarts: &Restarts) -> Vec<FlownTick> {
    let mut plain = 0;
    let channels: Vec<&Channel> = compacted(Compacted::Rows).collect();
    let mut row = vec![0; block.rows.len()];
    let mut events: Vec<DeviceEvent> = Vec::new();
    let mut inputs = InputsRecord::default();
    let mut message = Vec::new();
    let mut flown = Vec::with_capacity(block.digests.len() + 1);
    for op in &block.ops {
        match *op {
            Op::Row(number) => {
                let number = usize::from(number);
                let Some(channel) = channels.get(number) else { break };
                let Some(words) = block.rows[number].row(row[number]) else { break };
                row[number] += 1;
                if ![ChannelId::Hardware, ChannelId::Inputs].contains(&channel.id) {
                    continue;
                }
                message.clear();
                message.extend_from_slice(&cdr::HEADER);
                message.extend(words.iter().flat_map(|word| word.to_le_bytes()));
                if channel.id == ChannelId::Inputs {
                    let Ok(read) = cdr::decode(&message) else { break };
                    inputs = read;
                } else {
                    let Ok(event) = cdr::decode(&message) else { break };
                    events.push(event);
                }
            }
            Op::State | Op::Keyframe => {
                let of_tick = Inputs { events: &events, world: inputs.world };
                let mut outputs = None;
                if is_kept(state.tick.wrapping_add(1)) {
                    let (next, seen) = step(&of.aircraft, &state, &of_tick);
                    (state, outputs) = (next, Some(Box::new(seen)));
                } else {
                    step_state(&of.aircraft, &mut state, &of_tick);
                }
                events.clear();
                flown.push(FlownTick { state, outputs });
            }
            Op::Plain => {
                if let Some((_, restart)) = restarts.iter().find(|(number, _)| *number == plain) {
                    state = *restart;
                }
                plain += 1;
            }
            Op::View(_) | Op::ChunkEnd => {}
        }
    }
    flown
}
