//! `fly --rerun`: the flight in the rerun viewer while it is flown.

use std::path::PathBuf;

/// Where it is shown, and how.
#[derive(clap::Args)]
pub struct LiveArgs {
    /// Show the flight in a rerun viewer while it is flown: in the one that listens there, or in one that is
    /// started [without HOST:PORT: 127.0.0.1:9876]
    #[arg(long, value_name = "HOST:PORT", num_args = 0..=1, default_missing_value = "127.0.0.1:9876")]
    rerun: Option<String>,
    /// With --rerun: arrangement: pilot, engineer, rotor, latency, or a file of one's own [default: pilot]
    #[arg(long, value_name = "NAME|FILE", requires = "rerun")]
    layout: Option<String>,
    /// With --rerun: the viewer's program
    #[arg(long, value_name = "PROGRAM", requires = "rerun", default_value = "rerun")]
    viewer: PathBuf,
}

#[cfg(feature = "rerun")]
pub use with::{Live, beside};
#[cfg(not(feature = "rerun"))]
pub use without::{Live, beside};

#[cfg(not(feature = "rerun"))]
mod without {
    use super::LiveArgs;

    /// There is none.
    pub enum Live {}
    /// There is none.
    pub type Ready = Live;

    /// Flies.
    pub fn beside<T>(_: Option<Ready>, _: &recorder::Progress, flown: impl FnOnce() -> T) -> T {
        flown()
    }

    impl Live {
        /// There is none.
        pub fn begin(&mut self) -> anyhow::Result<()> {
            match *self {}
        }

        /// There is none.
        pub fn ready(self, _: &recorder::Flight, _: &recorder::Progress) -> Ready {
            self
        }

        /// Says what is missing, if it is wanted.
        pub fn wanted(args: &LiveArgs) -> anyhow::Result<Option<Self>> {
            let LiveArgs { rerun, layout: _, viewer: _ } = args;
            if rerun.is_some() {
                anyhow::bail!(
                    "--rerun: this program was built without `rerun`; build it with the default features"
                );
            }
            Ok(None)
        }
    }
}

#[cfg(feature = "rerun")]
mod with {
    use std::net::{Ipv4Addr, SocketAddr, TcpStream, ToSocketAddrs};
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::sync::mpsc::Receiver;
    use std::thread;
    use std::time::{Duration, SystemTime, UNIX_EPOCH};

    use anyhow::{Context, Result, bail};
    use engine::Aircraft;
    use engine::outputs::Validity;
    use logs::records::FlightEvent;
    use recorder::{Flight, Progress, Told};
    use replay::view::live::{LiveView, Pace, Tally};
    use replay::view::{About, Layout, Moment, level};

    use super::LiveArgs;
    use crate::view::{Viewer, layout};

    /// Between two looks at the flight, which shows itself every 40 ms.
    const LOOK: Duration = Duration::from_millis(20);
    /// Whether somebody listens is known by then.
    const ASKED: Duration = Duration::from_millis(500);

    /// The flight in a viewer.
    pub struct Live {
        place: String,
        layout: Layout,
        /// To be started, as none listens.
        start: Option<(Viewer, u16)>,
    }

    impl Live {
        /// What is wanted, if it is: refused where nobody listens and nobody can be started.
        pub fn wanted(args: &LiveArgs) -> Result<Option<Self>> {
            let Some(place) = &args.rerun else { return Ok(None) };
            if args.layout.as_deref().and_then(Layout::named) == Some(Layout::Compare) {
                bail!("--layout compare: for two logs, `tiltrotor view A --against B`");
            }
            let layout = layout(args.layout.as_deref(), false)?;
            let found: Vec<SocketAddr> = place
                .to_socket_addrs()
                .with_context(|| format!("--rerun {place}: expected HOST:PORT"))?
                .collect();
            let start = match found.first() {
                _ if found.iter().any(listens) => None,
                // Where a started viewer listens; another address, or another machine's, is not ours to start.
                Some(at) if at.ip() == Ipv4Addr::LOCALHOST => {
                    Some((Viewer::find(&args.viewer)?, at.port()))
                }
                _ => None,
            };
            Ok(Some(Self { place: place.clone(), layout, start }))
        }

        /// Starts a viewer where none listens, and says where the flight is shown.
        pub fn begin(&mut self) -> Result<()> {
            match self.start.take() {
                Some((viewer, port)) => {
                    viewer.listen(port)?;
                    complain!("live: in the viewer started at {}", self.place);
                }
                None => complain!("live: in the viewer at {}, whenever it listens", self.place),
            }
            Ok(())
        }

        /// Knows the flight that begins now.
        pub fn ready(self, flight: &Flight, progress: &Progress) -> Ready {
            let name = flight.out.file_stem();
            let title = name.map_or_else(String::new, |name| name.display().to_string());
            let began = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
            let recording_id = format!("tiltrotor-live-{}", began.as_nanos());
            let flown = vec![format!("being flown by {}", flight.identity.who(&[]))];
            Ready {
                place: self.place,
                layout: self.layout,
                about: About { title, recording_id, flown },
                aircraft: flight.aircraft.clone(),
                told: progress.listen_beside(),
            }
        }
    }

    /// All that is to be known before the flight.
    pub struct Ready {
        place: String,
        layout: Layout,
        about: About,
        aircraft: Aircraft,
        told: Receiver<Told>,
    }

    impl Ready {
        /// Shows the flight until it is over; says what came of it.
        fn show(self, progress: &Progress, over: &AtomicBool) -> String {
            recorder::step_aside();
            let mut view = LiveView::new(&self.place, self.about, self.layout, &self.aircraft);
            let (mut shown_tick, mut met) = (None, Validity::empty());
            let mut pace = Pace::default();
            // After the end once more, for the last of it.
            let mut last = false;
            while !last {
                last = over.load(Ordering::Acquire);
                view.look();
                for told in self.told.try_iter() {
                    if told.what == FlightEvent::Restarted {
                        view.restart(told.tick);
                    }
                    view.event(told.tick, level(told.level), &told.words);
                }
                let shown = progress.shown().filter(|shown| {
                    shown.outputs.tick > 0 && shown_tick != Some(shown.outputs.tick)
                });
                if let Some(shown) = shown {
                    shown_tick = Some(shown.outputs.tick);
                    let (mut outputs, world) = (shown.outputs, &shown.world);
                    // What was so between two looks is not missed: the hull may touch the ground for a tick.
                    outputs.validity |= shown.debrief.validity & !met;
                    met = shown.debrief.validity;
                    if shown.late_ns_max > pace.latest.1 {
                        pace.latest = (shown.timing.tick, shown.late_ns_max);
                    }
                    (pace.ticks, pace.overruns) = (outputs.tick, shown.overruns);
                    view.push(
                        Moment { outputs: &outputs, world, events: &[] },
                        &shown.timing,
                        pace,
                    );
                }
                if !last {
                    thread::sleep(LOOK);
                }
            }
            words(&view.finish(), &self.place)
        }
    }

    /// Says that the flight is over, whatever ended it.
    struct Over<'a>(&'a AtomicBool);

    impl Drop for Over<'_> {
        fn drop(&mut self) {
            self.0.store(true, Ordering::Release);
        }
    }

    /// Flies, and shows it meanwhile.
    pub fn beside<T>(live: Option<Ready>, progress: &Progress, flown: impl FnOnce() -> T) -> T {
        let Some(live) = live else { return flown() };
        let over = AtomicBool::new(false);
        let (flown, told) = thread::scope(|scope| {
            let shown = scope.spawn(|| live.show(progress, &over));
            let ends = Over(&over);
            let flown = flown();
            drop(ends);
            (flown, shown.join())
        });
        match told {
            Ok(words) => complain!("{words}"),
            Err(_) => complain!("live: the view died of a fault of ours; the log has all"),
        }
        flown
    }

    fn listens(at: &SocketAddr) -> bool {
        TcpStream::connect_timeout(at, ASKED).is_ok()
    }

    /// What came of it.
    fn words(tally: &Tally, place: &str) -> String {
        let Tally { rows, dropped, unseen, found, lost, complete } = *tally;
        if found == 0 {
            return format!("live: no viewer answered at {place}; `tiltrotor view` shows the log");
        }
        let mut words = format!("live: {rows} rows sent to the viewer at {place}");
        if lost > 0 {
            let times = if lost == 1 { "once".into() } else { format!("{lost} times") };
            words.push_str(&format!(", which was lost {times}"));
        }
        if unseen > 0 {
            words.push_str(&format!("; {unseen} without a viewer"));
        }
        if dropped > 0 {
            words.push_str(&format!("; {dropped} left out, as it was too slow"));
        }
        if !complete {
            words.push_str("; it does not have the end");
        }
        words + "; the log has all"
    }

    #[cfg(test)]
    mod tests {
        use super::*;

        #[test]
        fn what_came_of_it_is_told_in_words() {
            let whole = Tally { rows: 50, found: 1, complete: true, ..Tally::default() };
            let told = words(&whole, "here:1");
            assert_eq!(told, "live: 50 rows sent to the viewer at here:1; the log has all");
            let broken = Tally { lost: 2, unseen: 9, dropped: 3, complete: false, ..whole };
            let told = words(&broken, "here:1");
            for part in ["lost 2 times", "9 without a viewer", "3 left out", "not have the end"] {
                assert!(told.contains(part), "{told}");
            }
            assert!(words(&Tally::default(), "here:1").contains("no viewer answered"));
        }
    }
}
