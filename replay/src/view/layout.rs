//! How the viewer arranges a flight.
//!
//! ```text
//! ┌──────────────────┬──────────────────┐
//! │ 3D, following    │ plots, in tabs   │
//! │ the aircraft     │                  │
//! ├──────────────────┤                  │
//! │ overview │ map   │                  │
//! ├──────────────────┼──────────────────┤
//! │ events           │ modes; validity  │
//! └──────────────────┴──────────────────┘
//! ```
//! Two flights have the same places; each plot has the difference beside it.
//!
//! Rerun's own builder (`rerun::blueprint::Blueprint`) cannot set a view's properties from Rust: no
//! eye, no visible time, no legend. Its builder only logs archetypes to a recording of the
//! blueprint kind, so this does the same with the archetypes themselves, which it exports.

use rerun::blueprint::components::{
    ActiveTab, BackgroundKind, ColumnShare, ContainerKind, Corner2D, Eye3DKind, PanelState,
    RowShare, ViewClass,
};
use rerun::external::re_log_types::{BlueprintActivationCommand, LogMsg};
use rerun::external::re_sdk_types::blueprint::archetypes::{
    Background, ContainerBlueprint, EyeControls3D, LineGrid3D, PanelBlueprint, PlotLegend,
    TextLogColumns, TimeAxis, TimePanelBlueprint, ViewBlueprint, ViewContents, ViewportBlueprint,
    VisibleTimeRanges,
};
use rerun::external::re_sdk_types::blueprint::components::{self, RootContainer, TimelineName};
use rerun::external::re_sdk_types::blueprint::datatypes::{TextLogColumn, TextLogColumnKind};
use rerun::external::re_sdk_types::datatypes::{
    TimeInt, TimeRange, TimeRangeBoundary, Uuid, VisibleTimeRange,
};
use rerun::{AsComponents, RecordingStream, RecordingStreamBuilder, RecordingStreamResult};

/// How much of the line behind the aircraft is bright.
const FLOWN_NS: i64 = 30_000_000_000;

/// Without it the viewer shows a minute around the cursor.
const WHOLE_FLIGHT: components::TimeRange = components::TimeRange(TimeRange::EVERYTHING);

/// Name of a view or container in the blueprint.
type Id = String;

/// A plot's name, and the entities it shows.
type Graph = (&'static str, &'static [&'static str]);

/// Tabs of plots, each with its plots from top to bottom.
#[rustfmt::skip]
const PLOT_TABS: &[(&str, &[Graph])] = &[
    ("Flight", &[
        ("height, m", &["plots/height_m"]),
        ("airspeed, kt", &["plots/airspeed_kt"]),
        ("nacelle incidence, deg", &["plots/nacelle_deg"]),
        ("roll and pitch, deg", &["plots/attitude_deg/roll", "plots/attitude_deg/pitch"]),
        ("pilot's controls", &["plots/pilot"]),
    ]),
    ("Motion", &[
        ("heading, deg", &["plots/attitude_deg/heading"]),
        ("body rates, deg/s", &["plots/rates_degps"]),
        ("climb, ft/min", &["plots/climb_ft_per_min"]),
        ("angle of attack and sideslip, deg", &["plots/air_deg"]),
        ("load factor", &["plots/load_factor"]),
    ]),
    ("Controls", &[
        ("pilot's controls", &["plots/pilot"]),
        ("surfaces, deg", &["plots/surfaces_deg"]),
        ("blade collective at 3/4 radius, deg", &["plots/blades_deg"]),
        ("longitudinal cyclic, deg", &["plots/cyclic_deg"]),
        ("nacelle incidence, deg", &["plots/nacelle_deg"]),
    ]),
    ("Rotors and engines", &[
        ("rotor speed, rpm", &["plots/rotor_rpm"]),
        ("power, kW", &["plots/power_kW"]),
        ("torque at the mast, kN·m", &["plots/torque_kNm"]),
        ("thrust, kN", &["plots/thrust_kN"]),
        ("induced velocity, m/s", &["plots/induced_mps"]),
    ]),
    ("Gear and fuel", &[
        ("ground's push, kN", &["plots/gear/push_kN"]),
        ("gear extension", &["plots/gear/extension"]),
        ("fuel, kg", &["plots/fuel_kg"]),
    ]),
];

/// How a difference grows.
const GROWTH: &[Graph] = &[("logarithm to base 10 of the difference", &["growth"])];

/// Sends the layout, and has the viewer use it.
///
/// A view fits its axes, map and eye to what is there when it first appears. So a layout is sent
/// twice: at the start for a flight that never ends, and at the end, as other views (`edition`), to
/// be fitted to the whole flight.
pub fn send(recording: &RecordingStream, edition: u8, kind: Subject) -> RecordingStreamResult<()> {
    let Some(about) = recording.store_info() else { return Ok(()) };
    let (stream, storage) = RecordingStreamBuilder::new(about.application_id().clone())
        .enabled(true)
        .send_properties(false)
        .blueprint()
        .memory()?;
    stream.set_log_time_enabled(false);
    // How the viewer knows a blueprint's data.
    stream.set_time_sequence("blueprint", 0);
    let mut page = Page { stream, edition, kind, named: 0 };
    let root = page.root()?;
    page.panels(root)?;

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

/// What is laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// One flight.
    Flight,
    /// Two, and the difference.
    Comparison,
}

impl Subject {
    /// Before the names of the entities of each flight.
    fn roots(self) -> &'static [&'static str] {
        match self {
            Self::Flight => &["/"],
            Self::Comparison => &["/recorded/", "/reflown/"],
        }
    }

    /// An entity of every flight.
    fn each(self, name: &str) -> Vec<String> {
        self.roots().iter().map(|root| format!("{root}{name}")).collect()
    }
}

/// A layout that grows.
struct Page {
    stream: RecordingStream,
    edition: u8,
    kind: Subject,
    named: u8,
}

impl Page {
    fn root(&mut self) -> RecordingStreamResult<Uuid> {
        let chase = self.chase()?;
        let map = self.view("Map", "Map", "/", &self.kind.each("map/**"), &[])?;
        let overview = self.overview()?;
        let places =
            self.container(ContainerKind::Horizontal, "Places", &[overview, map], &[1.0, 1.0])?;
        let left =
            self.container(ContainerKind::Vertical, "Where", &[chase, places], &[2.0, 1.0])?;

        let mut tabs = Vec::new();
        for (name, graphs) in PLOT_TABS {
            let roots = self.kind.roots();
            let plots = self.plots(name, graphs, roots, "")?;
            tabs.push(match self.kind {
                Subject::Flight => plots,
                Subject::Comparison => {
                    let delta = self.plots("Difference", graphs, &["/delta/"], "Δ ")?;
                    self.container(ContainerKind::Horizontal, name, &[plots, delta], &[])?
                }
            });
        }
        if self.kind == Subject::Comparison {
            tabs.push(self.plots("Growth", GROWTH, &["/delta/"], "")?);
        }
        let right = self.container(ContainerKind::Tabs, "Plots", &tabs, &[])?;
        let above =
            self.container(ContainerKind::Horizontal, "Flight", &[left, right], &[11.0, 10.0])?;

        let columns = TextLogColumns::new().with_text_log_columns(
            [TextLogColumnKind::LogLevel, TextLogColumnKind::Body].map(column),
        );
        let events = self.view(
            "TextLog",
            "Events",
            "/events",
            &["$origin/**".into()],
            &[("TextLogColumns", &columns)],
        )?;
        let modes = self.kind.each("modes/**");
        let modes = self.view("StateTimeline", "Modes", "/", &modes, &[])?;
        let validity = self.kind.each("validity/**");
        let validity = self.view("StateTimeline", "Validity", "/", &validity, &[])?;
        let modes = self.container(ContainerKind::Tabs, "Lanes", &[modes, validity], &[])?;
        let below =
            self.container(ContainerKind::Horizontal, "Story", &[events, modes], &[11.0, 10.0])?;
        let root = self.id();
        self.put_container(root, ContainerKind::Vertical, "Review", &[above, below], &[3.0, 1.0])?;
        Ok(root)
    }

    /// Flies along, behind and to the left of the aircraft, turning with its heading: the view's
    /// origin is the chase frame. (An eye that tracks an entity goes with it only from where the
    /// viewer happens to start, and loses it when time jumps.)
    fn chase(&mut self) -> RecordingStreamResult<Id> {
        let eye = EyeControls3D::new()
            .with_kind(Eye3DKind::Orbital)
            .with_position([-16.0, -12.5, -7.0])
            .with_look_target([0.5, 0.0, -0.5])
            .with_eye_up([0.0, 0.0, -1.0]);
        let grid = LineGrid3D::new().with_visible(false);
        let origin = format!("{}world/chase", self.kind.roots()[0]);
        self.scene("Aircraft", &origin, &[], &eye, &grid)
    }

    /// Stands where the whole flight is seen; the ground would be most of what there is to frame.
    fn overview(&mut self) -> RecordingStreamResult<Id> {
        let eye = EyeControls3D::new().with_kind(Eye3DKind::Orbital).with_eye_up([0.0, 0.0, -1.0]);
        let grid = LineGrid3D::new().with_spacing(10.0).with_color(0xFF_FF_FF_50);
        let origin = format!("{}world", self.kind.roots()[0]);
        let without: Vec<String> = ["ground", "grid"]
            .into_iter()
            .flat_map(|what| self.kind.each(&format!("world/{what}/**")))
            .map(|entity| format!("- {entity}"))
            .collect();
        self.scene("Overview", &origin, &without, &eye, &grid)
    }

    fn scene(
        &mut self,
        name: &str,
        origin: &str,
        without: &[String],
        eye: &EyeControls3D,
        grid: &LineGrid3D,
    ) -> RecordingStreamResult<Id> {
        let mut queries = self.kind.each("world/**");
        if self.kind == Subject::Comparison {
            queries.push("/delta/apart".into());
        }
        queries.extend_from_slice(without);
        let sky = Background::new(BackgroundKind::SolidColor).with_color(0x8F_B4_D6_FF);
        let properties: &[(&str, &dyn AsComponents)] =
            &[("EyeControls3D", eye), ("Background", &sky), ("LineGrid3D", grid)];
        let id = self.view("3D", name, origin, &queries, properties)?;
        let start = TimeRangeBoundary::CursorRelative(TimeInt(-FLOWN_NS));
        let range = TimeRange { start, end: TimeRangeBoundary::AT_CURSOR };
        let lately = VisibleTimeRange { timeline: super::SIM_TIME.into(), range };
        let lately = VisibleTimeRanges::new([lately]);
        for flown in self.kind.each("world/flown") {
            let place = format!("{id}/ViewContents/overrides{flown}/visualizers");
            self.stream.log(place, &lately)?;
        }
        Ok(id)
    }

    /// Plots from top to bottom, each with its lines under every root.
    fn plots(
        &mut self,
        name: &str,
        graphs: &[Graph],
        roots: &[&str],
        mark: &str,
    ) -> RecordingStreamResult<Id> {
        let mut plots = Vec::new();
        for (name, paths) in graphs {
            let of = |root: &&str| -> Vec<String> {
                paths.iter().map(|path| format!("{root}{path}/**")).collect()
            };
            let queries: Vec<String> = roots.iter().flat_map(of).collect();
            plots.push(self.plot(&format!("{mark}{name}"), &queries)?);
        }
        self.container(ContainerKind::Vertical, name, &plots, &[])
    }

    fn plot(&mut self, name: &str, queries: &[String]) -> RecordingStreamResult<Id> {
        // Two columns of plots are too narrow for two legends: the same colours are in the other one.
        let told =
            self.kind == Subject::Flight || queries.iter().all(|of| of.starts_with("/delta/"));
        let legend = PlotLegend::new().with_corner(Corner2D::LeftTop).with_visible(told);
        let axis = TimeAxis::new().with_view_range(WHOLE_FLIGHT);
        let properties: &[(&str, &dyn AsComponents)] =
            &[("PlotLegend", &legend), ("TimeAxis", &axis)];
        self.view("TimeSeries", name, "/", queries, properties)
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

    fn container(
        &mut self,
        kind: ContainerKind,
        name: &str,
        contents: &[Id],
        shares: &[f32],
    ) -> RecordingStreamResult<Id> {
        let id = self.id();
        self.put_container(id, kind, name, contents, shares)
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

    fn panels(&self, root: Uuid) -> RecordingStreamResult<()> {
        let viewport = ViewportBlueprint::new()
            .with_root_container(RootContainer(root))
            .with_auto_layout(false)
            .with_auto_views(false);
        self.stream.log("viewport", &viewport)?;
        let closed = PanelBlueprint::new().with_state(PanelState::Collapsed);
        self.stream.log("blueprint_panel", &closed)?;
        self.stream.log("selection_panel", &closed)?;
        let time = TimePanelBlueprint::new()
            .with_state(PanelState::Collapsed)
            .with_timeline(TimelineName(super::SIM_TIME.into()));
        self.stream.log("time_panel", &time)
    }

    fn id(&mut self) -> Uuid {
        self.named += 1;
        let mut bytes = *b"tiltrotor-view\0\0";
        bytes[14] = self.edition;
        bytes[15] = self.named;
        Uuid { bytes }
    }
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
    use crate::view::plots::PLOTS;

    #[test]
    fn an_id_looks_as_the_viewer_expects() {
        let bytes = [0xAB; 16];
        assert_eq!(hyphenated(Uuid { bytes }), "abababab-abab-abab-abab-abababababab");
    }

    #[test]
    fn every_plot_is_in_a_tab_and_every_tab_has_plots() {
        let shown: Vec<&str> = PLOT_TABS
            .iter()
            .flat_map(|(_, plots)| *plots)
            .flat_map(|(_, paths)| *paths)
            .copied()
            .collect();
        for plot in PLOTS {
            assert!(shown.iter().any(|path| plot.path.starts_with(path)), "{}", plot.path);
        }
        for path in shown {
            assert!(PLOTS.iter().any(|plot| plot.path.starts_with(path)), "{path}");
        }
    }
}
