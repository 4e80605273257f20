//! How a layout is told to the viewer: views, containers and panels.
//!
//! Rerun's own builder (`rerun::blueprint::Blueprint`) cannot set a view's properties from Rust: no
//! eye, no visible time, no legend. Its builder only logs archetypes to a recording of the
//! blueprint kind, so this does the same with the archetypes themselves, which it exports.

use engine::STEP_NS;
use rerun::blueprint::components::{
    ActiveTab, BackgroundKind, ColumnShare, ContainerKind, Corner2D, Eye3DKind, LinkAxis,
    PanelState, PlayState, RowShare, ViewClass,
};
use rerun::external::re_log_types::{BlueprintActivationCommand, LogMsg};
use rerun::external::re_sdk_types::blueprint::archetypes::{
    Background, ContainerBlueprint, EyeControls3D, LineGrid3D, PanelBlueprint, PlotLegend,
    TextLogColumns, TimeAxis, TimePanelBlueprint, ViewBlueprint, ViewContents, ViewportBlueprint,
    VisibleTimeRanges, VisualBounds2D,
};
use rerun::external::re_sdk_types::blueprint::components::{self, RootContainer, TimelineName};
use rerun::external::re_sdk_types::blueprint::datatypes::{
    TextLogColumn, TextLogColumnKind, TimelineColumn,
};
use rerun::external::re_sdk_types::datatypes::{
    Range2D, TimeInt, TimeRange, TimeRangeBoundary, Uuid, VisibleTimeRange,
};
use rerun::{AsComponents, RecordingStream, RecordingStreamBuilder, RecordingStreamResult};

use super::layout::Layout;
use super::parts::{Part, Plan, Shown};
use super::{corridor, parts};

/// How much of the line behind the aircraft is bright.
const FLOWN_NS: i64 = 30_000_000_000;
/// Time axes end after the flight by this part of it, so that its last moment is seen.
const AFTER_NORM: f64 = 0.02;
/// The viewer's place for what all views with a linked time axis share (`GLOBAL_VIEW_ID` in its source).
const ALL_VIEWS: [u8; 16] = [
    0x5C, 0x0D, 0xCA, 0x6A, 0xE6, 0x3F, 0x9C, 0xF7, 0xF6, 0x57, 0x26, 0x02, 0x59, 0x04, 0x74, 0xCC,
];

/// Name of a view or container in the blueprint.
type Id = String;

/// Sends the layout, and has the viewer use it.
///
/// A view fits its axes, map and eye to what is there when it first appears. So a layout is sent
/// twice: at the start for a flight that never ends, and at the end, as other views (`edition`), to
/// be fitted to the whole flight, whose first and last tick are the `span`. With `mark` it has that name.
pub fn send(
    recording: &RecordingStream,
    edition: u8,
    (layout, plan): (&Layout, &Plan),
    mark: &str,
    span: Option<(u64, u64)>,
) -> RecordingStreamResult<()> {
    let Some(about) = recording.store_info() else { return Ok(()) };
    let mut builder = RecordingStreamBuilder::new(about.application_id().clone())
        .enabled(true)
        .send_properties(false);
    if !mark.is_empty() {
        builder = builder.recording_id(mark);
    }
    let (stream, storage) = builder.blueprint().memory()?;
    stream.set_log_time_enabled(false);
    // How the viewer knows a blueprint's data.
    stream.set_time_sequence("blueprint", 0);
    let mut page = Page { stream, edition, plan, named: 0 };
    let root = page.id();
    let all = page.part(&layout.tree(plan))?;
    page.put_container(root, ContainerKind::Vertical, "Review", &[all], &[])?;
    page.panels(root, span, layout.before_norm(plan))?;

    let messages = storage.take();
    let blueprint = messages.iter().find_map(|message| match message {
        LogMsg::SetStoreInfo(info) => Some(info.info.store_id.clone()),
        _ => None,
    });
    if let Some(blueprint) = blueprint {
        recording.send_blueprint(messages, BlueprintActivationCommand::make_active(blueprint));
    }
    Ok(())
}

/// A layout that grows.
struct Page<'a> {
    stream: RecordingStream,
    edition: u8,
    plan: &'a Plan,
    named: u16,
}

impl Page<'_> {
    fn part(&mut self, part: &Part) -> RecordingStreamResult<Id> {
        let (kind, name, parts, shares) = match part {
            Part::View(shown) => return self.shown(shown),
            Part::Tabs(name, parts) => (ContainerKind::Tabs, name, parts, Vec::new()),
            Part::Across(name, shares, parts) => {
                (ContainerKind::Horizontal, name, parts, shares.clone())
            }
            Part::Down(name, shares, parts) => {
                (ContainerKind::Vertical, name, parts, shares.clone())
            }
        };
        let contents: Vec<Id> =
            parts.iter().map(|part| self.part(part)).collect::<RecordingStreamResult<_>>()?;
        let id = self.id();
        self.put_container(id, kind, name, &contents, &shares)
    }

    fn shown(&mut self, shown: &Shown) -> RecordingStreamResult<Id> {
        match shown {
            Shown::Aircraft { eye_m, without } => self.chase(*eye_m, without),
            Shown::Overview => self.overview(),
            Shown::Map => {
                let queries = self.plan.each("map/**");
                self.view("Map", "Map", "/", &queries, &[])
            }
            Shown::Corridor => self.corridor(),
            Shown::Events => self.events(),
            Shown::Lanes { name, of } => {
                let queries = self.plan.each(of);
                let axis = TimeAxis::new().with_link(LinkAxis::LinkToGlobal);
                self.view("StateTimeline", name, "/", &queries, &[("TimeAxis", &axis)])
            }
            Shown::Plot { title, queries, legend } => self.plot(title, queries, *legend),
            Shown::Heading => self.document("Flight", &format!("/{}", parts::HEADING)),
            Shown::Numbers if self.plan.is_comparison() => {
                self.document("Both at the cursor", &format!("/{}", parts::NUMBERS_OF_TWO))
            }
            Shown::Numbers => self.document("At the cursor", &format!("/{}", parts::NUMBERS)),
            Shown::NumbersOfRotors => {
                self.document("Rotors at the cursor", &format!("/{}", parts::NUMBERS_OF_ROTORS))
            }
            Shown::Document { name, entity } => self.document(name, entity),
        }
    }

    fn document(&mut self, name: &str, entity: &str) -> RecordingStreamResult<Id> {
        self.view("TextDocument", name, entity, &["$origin".into()], &[])
    }

    /// Flies along, behind and to the left of the aircraft, turning with its heading: the view's
    /// origin is the chase frame. (An eye that tracks an entity goes with it only from where the
    /// viewer happens to start, and loses it when time jumps.)
    fn chase(&mut self, eye_m: [f32; 3], without: &[&str]) -> RecordingStreamResult<Id> {
        let eye = EyeControls3D::new()
            .with_kind(Eye3DKind::Orbital)
            .with_position(eye_m)
            .with_look_target([0.5, 0.0, -0.5])
            .with_eye_up([0.0, 0.0, -1.0]);
        let grid = LineGrid3D::new().with_visible(false);
        let origin = format!("{}world/chase", self.plan.roots[0]);
        let without = self.without(without);
        self.scene("Aircraft", &origin, &without, &eye, &grid)
    }

    /// Stands where the whole flight is seen; the ground would be most of what there is to frame.
    fn overview(&mut self) -> RecordingStreamResult<Id> {
        let eye = EyeControls3D::new().with_kind(Eye3DKind::Orbital).with_eye_up([0.0, 0.0, -1.0]);
        let grid = LineGrid3D::new().with_spacing(10.0).with_color(0xFF_FF_FF_50);
        let origin = format!("{}world", self.plan.roots[0]);
        let without =
            ["ground", "grid", "start", "chase/scale", "aircraft/forces", "aircraft/moments"];
        let without = self.without(&without);
        self.scene("Overview", &origin, &without, &eye, &grid)
    }

    fn without(&self, parts: &[&str]) -> Vec<String> {
        parts
            .iter()
            .flat_map(|part| self.plan.each(&format!("world/{part}/**")))
            .map(|entity| format!("- {entity}"))
            .collect()
    }

    fn scene(
        &mut self,
        name: &str,
        origin: &str,
        without: &[String],
        eye: &EyeControls3D,
        grid: &LineGrid3D,
    ) -> RecordingStreamResult<Id> {
        let mut queries = self.plan.each("world/**");
        if self.plan.is_comparison() {
            queries.push("/delta/apart".into());
        }
        queries.extend_from_slice(without);
        let sky = Background::new(BackgroundKind::SolidColor).with_color(0x8F_B4_D6_FF);
        let properties: &[(&str, &dyn AsComponents)] =
            &[("EyeControls3D", eye), ("Background", &sky), ("LineGrid3D", grid)];
        let id = self.view("3D", name, origin, &queries, properties)?;
        let start = TimeRangeBoundary::CursorRelative(TimeInt(-FLOWN_NS));
        let range = TimeRange { start, end: TimeRangeBoundary::AT_CURSOR };
        let lately = VisibleTimeRange { timeline: super::basics::SIM_TIME.into(), range };
        let lately = VisibleTimeRanges::new([lately]);
        for flown in self.plan.each("world/flown") {
            let place = format!("{id}/ViewContents/overrides{flown}/visualizers");
            self.stream.log(place, &lately)?;
        }
        Ok(id)
    }

    fn corridor(&mut self) -> RecordingStreamResult<Id> {
        let [[slow, fast], [low, high]] = corridor::SEEN;
        let (a, b) = (corridor::place(slow, high), corridor::place(fast, low));
        let range = |from: f32, to: f32| [f64::from(from), f64::from(to)].into();
        let bounds =
            VisualBounds2D::new(Range2D { x_range: range(a[0], b[0]), y_range: range(a[1], b[1]) });
        let dark = Background::new(BackgroundKind::SolidColor).with_color(0x1C_20_26_FF);
        let queries = self.plan.each("corridor/**");
        let properties: &[(&str, &dyn AsComponents)] =
            &[("VisualBounds2D", &bounds), ("Background", &dark)];
        let name = "Corridor: calibrated airspeed, kt, and nacelle incidence, deg";
        self.view("2D", name, "/", &queries, properties)
    }

    fn events(&mut self) -> RecordingStreamResult<Id> {
        let columns = TextLogColumns::new()
            .with_timeline_columns([TimelineColumn {
                timeline: super::basics::SIM_TIME.into(),
                visible: true.into(),
            }])
            .with_text_log_columns(
                [TextLogColumnKind::LogLevel, TextLogColumnKind::Body].map(column),
            );
        let queries = self.plan.each("events/**");
        self.view("TextLog", "Events", "/", &queries, &[("TextLogColumns", &columns)])
    }

    fn plot(&mut self, title: &str, queries: &[String], told: bool) -> RecordingStreamResult<Id> {
        let legend = PlotLegend::new().with_corner(Corner2D::LeftTop).with_visible(told);
        let axis = TimeAxis::new().with_link(LinkAxis::LinkToGlobal);
        let properties: &[(&str, &dyn AsComponents)] =
            &[("PlotLegend", &legend), ("TimeAxis", &axis)];
        self.view("TimeSeries", title, "/", queries, properties)
    }

    fn view(
        &mut self,
        class: &str,
        name: &str,
        origin: &str,
        queries: &[String],
        properties: &[(&str, &dyn AsComponents)],
    ) -> RecordingStreamResult<Id> {
        let id = format!("view/{}", hyphenated(self.id()));
        self.stream.log(
            format!("{id}/ViewContents"),
            &ViewContents::new(queries.iter().map(String::as_str)),
        )?;
        let view = ViewBlueprint::new(ViewClass(class.into()))
            .with_display_name(name)
            .with_space_origin(origin);
        self.stream.log(id.as_str(), &view)?;
        for (property, value) in properties {
            self.stream.log(format!("{id}/{property}"), *value)?;
        }
        Ok(id)
    }

    fn put_container(
        &self,
        id: Uuid,
        kind: ContainerKind,
        name: &str,
        contents: &[Id],
        shares: &[f32],
    ) -> RecordingStreamResult<Id> {
        let path = format!("container/{}", hyphenated(id));
        let mut container = ContainerBlueprint::new(kind)
            .with_display_name(name)
            .with_contents(contents.iter().map(String::as_str));
        container = match kind {
            ContainerKind::Tabs => match contents.first() {
                Some(first) => container.with_active_tab(ActiveTab(first.as_str().into())),
                None => container,
            },
            _ if shares.is_empty() => container,
            ContainerKind::Horizontal => {
                container.with_col_shares(shares.iter().map(|&share| ColumnShare(share.into())))
            }
            _ => container.with_row_shares(shares.iter().map(|&share| RowShare(share.into()))),
        };
        self.stream.log(path.as_str(), &container)?;
        Ok(path)
    }

    fn panels(
        &self,
        root: Uuid,
        span: Option<(u64, u64)>,
        before_norm: f64,
    ) -> RecordingStreamResult<()> {
        let viewport = ViewportBlueprint::new()
            .with_root_container(RootContainer(root))
            .with_auto_layout(false)
            .with_auto_views(false);
        self.stream.log("viewport", &viewport)?;
        let closed = PanelBlueprint::new().with_state(PanelState::Collapsed);
        self.stream.log("blueprint_panel", &closed)?;
        self.stream.log("selection_panel", &closed)?;
        let mut time = TimePanelBlueprint::new()
            .with_state(PanelState::Collapsed)
            .with_timeline(TimelineName(super::basics::SIM_TIME.into()));
        if span.is_none() {
            // Of a flight that goes on the latest is shown.
            time = time.with_play_state(PlayState::Following);
        }
        self.stream.log("time_panel", &time)?;
        let all = format!("view/{}/TimeAxis", hyphenated(Uuid { bytes: ALL_VIEWS }));
        self.stream.log(all, &TimeAxis::new().with_view_range(whole(span, before_norm)))
    }

    fn id(&mut self) -> Uuid {
        self.named += 1;
        let mut bytes = *b"tiltrotor-vw\0\0\0\0";
        bytes[13] = self.edition;
        bytes[14..].copy_from_slice(&self.named.to_be_bytes());
        Uuid { bytes }
    }
}

/// All of a flight, with room for legends before it. Without it the viewer shows a minute around the cursor.
fn whole(span: Option<(u64, u64)>, before_norm: f64) -> components::TimeRange {
    let Some((first, last)) = span else { return components::TimeRange(TimeRange::EVERYTHING) };
    let ns = |tick: f64| TimeRangeBoundary::Absolute(TimeInt((tick * STEP_NS as f64) as i64));
    let (first, last) = (first as f64, last as f64);
    let length = last - first;
    let (start, end) = (ns(first - before_norm * length), ns(last + AFTER_NORM * length));
    components::TimeRange(TimeRange { start, end })
}

fn column(kind: TextLogColumnKind) -> TextLogColumn {
    TextLogColumn { kind, visible: true.into() }
}

fn hyphenated(id: Uuid) -> String {
    let mut text = String::new();
    for (i, byte) in id.bytes.iter().enumerate() {
        if matches!(i, 4 | 6 | 8 | 10) {
            text.push('-');
        }
        text.push_str(&format!("{byte:02x}"));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_id_looks_as_the_viewer_expects() {
        let bytes = [0xAB; 16];
        assert_eq!(hyphenated(Uuid { bytes }), "abababab-abab-abab-abab-abababababab");
    }
}
