use engine::trim::{Target, trim};
#[test]
fn look() {
    let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap();
    for (tilt, kt, flap) in [
        (0.0, 0.0, 2),
        (0.0, 20.0, 2),
        (0.0, 40.0, 2),
        (0., 60., 2),
        (0.0, 80.0, 2),
        (0., 100., 2),
        (30., 80., 1),
        (30., 120., 1),
        (60., 100., 1),
        (60., 140., 1),
        (90., 140., 0),
        (90., 180., 0),
        (90., 220., 0),
    ] {
        let target = Target {
            mast_tilt_rad: f64::to_radians(tilt),
            airspeed_mps: kt * 1852. / 3600.,
            flap_detent: flap,
            rpm_select: if tilt == 90. { 2 } else { 0 },
            ..Target::default()
        };
        let t0 = std::time::Instant::now();
        match trim(&xv15, &target) {
            Ok(t) => println!(
                "{tilt} {kt}: θ {:.2} stick {:.2} in lever {:.3} θ75 {:.2} P {:.0} kW T {:.0} res {:.1e} {:?}",
                t.report.pitch_rad.to_degrees(),
                t.report.stick_from_aft_m / 0.0254,
                t.report.lever_norm,
                t.report.collective_rad.to_degrees(),
                t.report.power_w * 1e-3,
                t.report.thrust_n.right / 4.448,
                t.report.residual,
                t0.elapsed()
            ),
            Err(e) => println!("{tilt} {kt}: {e} {:?}", t0.elapsed()),
        }
    }
}
#[test]
fn lin() {
    let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap();
    for (tilt, kt, flap, scas) in [
        (0.0, 0.0, 2, 0),
        (0., 0., 2, 1),
        (0.0, 80.0, 2, 0),
        (60., 140., 1, 0),
        (90., 180., 0, 0),
        (90., 180., 0, 1),
    ] {
        let target = Target {
            mast_tilt_rad: f64::to_radians(tilt),
            airspeed_mps: kt * 1852. / 3600.,
            flap_detent: flap,
            scas_on: scas,
            rpm_select: if tilt == 90. { 2 } else { 0 },
            ..Target::default()
        };
        let t = trim(&xv15, &target).unwrap();
        let l = engine::linearize::linearize(&xv15, &t, &target.world);
        println!("--- {tilt} {kt} scas {scas}: {} states", l.states.len());
        for m in engine::modes::modes(&l, target.airspeed_mps) {
            println!(
                "{:28} {:9.4} {:+9.4}j ω {:7.3} ζ {:6.3} fast {} {}",
                m.name,
                m.eigenvalue.re,
                m.eigenvalue.im,
                m.frequency_radps(),
                m.damping(),
                m.fast,
                m.state
            );
        }
    }
}
