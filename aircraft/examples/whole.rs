use engine::{step, Inputs}; use engine::inputs::World; use engine::math::*;
fn main() {
    let mut x = ::aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap_or_else(|e| panic!("{e}"));
    x.cockpit = aircraft::cockpit("pilot.toml", aircraft::PILOT_MAP).unwrap();
    let start = aircraft::start("default.toml", aircraft::DEFAULT_SCENARIO).unwrap();
    let s0 = start.state(&x);
    let inputs = Inputs { events: &[], world: World::default() };
    let (_, o) = step(&x, &s0, &inputs);
    println!("start: rpm {:.2} coll {:.2} pitch {:.2} T {:.0} Q {:.0} v {:.2} lever {} v {:?} flap a {:.2} o {:.2} cone {:.2} P {:.0} kW", s0.plant.rotor_speed_radps*30.0/PI, s0.actuators.collective_rad.left*57.3, o.euler.pitch_rad*57.3, o.rotors.left.thrust_n, o.rotors.left.torque_n_m, o.rotors.left.induced_mps, s0.cockpit.collective_norm, s0.plant.velocity_mps, o.rotors.left.tilt_aft_rad*57.3, o.rotors.left.tilt_outboard_rad*57.3, o.rotors.left.coning_rad*57.3, o.rotors.left.power_w*2e-3);
    let mut s = s0; s.cockpit.collective_norm = 0.6;
    for k in 0..1500 { let r = step(&x, &s, &inputs); s = r.0; if k%125==0 { let o=r.1; println!("t {:.1} h {:.2} vz {:.2} rpm {:.2} coll {:.2} T {:.0} P {:.0} pitch {:.2} q {:.3} tilt {:.2} {:.2} val {}", k as f64*0.004, o.height_above_ground_m, -o.velocity_mps.z, o.rotor_speed_radps*30.0/PI, s.actuators.collective_rad.left*57.3, o.rotors.left.thrust_n, o.rotors.left.power_w*2e-3, o.euler.pitch_rad*57.3, o.angular_rate_radps.y, o.rotors.left.tilt_aft_rad*57.3, o.rotors.left.tilt_outboard_rad*57.3, o.validity); } }
    let t=std::time::Instant::now(); let mut best=f64::MAX; for _ in 0..40 { let t=std::time::Instant::now(); for _ in 0..1000 { std::hint::black_box(step(&x, std::hint::black_box(&s), &inputs)); } best=best.min(t.elapsed().as_nanos() as f64/1000.0); } println!("{best:.0} ns a tick ({:?})", t.elapsed());
}
