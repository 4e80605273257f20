//! A viewer that is running, told where to look.

use std::time::{Duration, Instant};

use engine::STEP_NS;
use re_protos::common::v1alpha1::{Timeline, TimelineTime};
use re_protos::sdk_comms::v1alpha1::viewer_control_service_client::ViewerControlServiceClient;
use re_protos::sdk_comms::v1alpha1::{
    GetViewerStateRequest, GetViewerStateResponse, SetTimeCursorRequest,
};
use tonic::transport::{Channel, Endpoint};

use super::basics::{SIM_TIME, TICKS_PER_ROW};

/// Between two looks at whether the viewer has what it is to show.
const PAUSE: Duration = Duration::from_millis(100);
/// From one row to the next.
const ROW_NS: i64 = (TICKS_PER_ROW * STEP_NS) as i64;

/// Why a viewer does not show what it is to show.
#[derive(Debug, thiserror::Error)]
pub enum ControlError {
    /// No runtime for it.
    #[error("cannot speak to the viewer: {0}")]
    Runtime(#[from] std::io::Error),
    /// No such place.
    #[error("cannot speak to the viewer: {0}")]
    Place(#[from] tonic::transport::Error),
    /// It refused.
    #[error("the viewer does not go there: {0}")]
    Refused(Box<tonic::Status>),
    /// It has not opened the recording in time.
    #[error("the viewer did not open the recording within {0:.0} s")]
    Late(f64),
    /// It ended.
    #[error("the viewer ended")]
    Ended,
}

/// Moves the time cursor of the viewer that listens at this port to a tick, as soon as it has a recording
/// that goes so far, and stops it there.
///
/// # Errors
/// When it has none in time, ends meanwhile, or refuses.
pub fn go_to(
    port: u16,
    tick: u64,
    patience: Duration,
    mut alive: impl FnMut() -> bool,
) -> Result<(), ControlError> {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    let place = Endpoint::from_shared(format!("http://127.0.0.1:{port}"))?
        .connect_timeout(PAUSE)
        .timeout(Duration::from_secs(5));
    let time_ns = i64::try_from(tick.saturating_mul(STEP_NS)).unwrap_or(i64::MAX);
    let began = Instant::now();
    loop {
        if !alive() {
            return Err(ControlError::Ended);
        }
        if began.elapsed() > patience {
            return Err(ControlError::Late(patience.as_secs_f64()));
        }
        let gone = runtime.block_on(async {
            let Ok(channel) = place.connect().await else { return Ok(false) };
            attempt(&mut ViewerControlServiceClient::new(channel), time_ns).await
        });
        match gone {
            Ok(true) => return Ok(()),
            Ok(false) => std::thread::sleep(PAUSE),
            Err(refused) => return Err(ControlError::Refused(refused)),
        }
    }
}

/// Goes there if the recording is open as far as that.
async fn attempt(
    viewer: &mut ViewerControlServiceClient<Channel>,
    time_ns: i64,
) -> Result<bool, Box<tonic::Status>> {
    let state = viewer.get_viewer_state(GetViewerStateRequest {}).await?.into_inner();
    if !reaches(&state, time_ns) {
        return Ok(false);
    }
    let there = SetTimeCursorRequest {
        store_id: state.active_store_id,
        timeline: Some(Timeline { name: SIM_TIME.into() }),
        time: Some(TimelineTime { time: time_ns }),
        play: false,
    };
    viewer.set_time_cursor(there).await?;
    Ok(true)
}

/// Whether the recording that is shown goes as far as that time; the last ticks of a flight may be short of a row.
fn reaches(state: &GetViewerStateResponse, time_ns: i64) -> bool {
    let shown = state.recordings.iter().filter(|one| one.store_id == state.active_store_id);
    shown.flat_map(|recording| &recording.timelines).any(|timeline| {
        timeline.timeline.as_ref().is_some_and(|timeline| timeline.name == SIM_TIME)
            && timeline.time_range.is_some_and(|range| range.end.saturating_add(ROW_NS) > time_ns)
    })
}
