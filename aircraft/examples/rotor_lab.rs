use engine::aero::Motion;
use engine::frames::Vec3;
use engine::math::*;
use engine::rotors::{self, Inputs, Outputs, Params, State};
const DEG: f64 = PI/180.0;
pub fn inputs(rpm: f64, coll: f64) -> Inputs {
    Inputs { motion: Motion { cg_m: Vec3::new(7.62,0.0,2.54), airspeed_mps: Vec3::zero(), angular_rate_radps: Vec3::zero(), density_kg_per_m3: 1.225 },
        sound_speed_mps: 340.3, mast_tilt_rad: 0.0, mast_tilt_rate_radps: 0.0, rotor_speed_radps: rpm*PI/30.0, collective_rad: coll, cyclic_forward_rad: 0.0, cyclic_outboard_rad: 0.0, hub_height_m: 1e9 }
}
pub fn settle(p: &Params, i: &Inputs) -> (State, Outputs) {
    let mut s = State::default();
    for _ in 0..3000 { s = rotors::rotor(p, &p.blade(), &s, i).0; }
    (s, rotors::rotor(p, &p.blade(), &s, i).1)
}
fn main() {
    let x = aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap_or_else(|e| panic!("{e}"));
    let mut p = x.rotors.clone();
    for a in std::env::args().skip(1) { if let Some(v)=a.strip_prefix("k=") { p.inflow.induced_power_factor = v.parse().unwrap(); } if let Some(v)=a.strip_prefix("b=") { p.blade.tip_loss_norm = v.parse().unwrap(); } }
    let q = |c: f64| { let mut i = inputs(768.0/12.5*30.0/PI, c); i.sound_speed_mps=340.3; let (s,o)=settle(&p,&i); let om=i.rotor_speed_radps; let tip=om*p.radius_m; let cp=o.power_w/(1.225*p.disc_area_m2()*tip*tip*tip); (o.thrust_coefficient,cp,s,o)};
    let oarf=[(-4.,0.001698,0.000193,0.256),(0.,0.004063,0.000315,0.5814),(4.,0.007391,0.000588,0.7641),(7.,0.010104,0.000913,0.7866),(8.,0.011063,0.001044,0.7881),(10.,0.013089,0.001358,0.7797),(12.5,0.015101,0.001812,0.7242)];
    for (th,ct,cp,fm) in oarf {
        let (mut lo,mut hi)=(-10.0*DEG,30.0*DEG);
        for _ in 0..40 { let m=0.5*(lo+hi); if q(m).0<ct {lo=m} else {hi=m} }
        let (c,pw,s,o)=q(lo);
        println!("th {th:5} CT {ct:.6} coll {:.2} (off {:.2}) CT {c:.6} CP {pw:.6} pub {cp:.6} ({:+.1}%) FM {:.4} pub {fm:.4} ({:+.3}) v {:.2} cone {:.2} stall {:.2}", lo/DEG, lo/DEG-th, (pw/cp-1.0)*100.0, c*sqrt(c/2.0)/pw, c*sqrt(c/2.0)/pw-fm, s.inflow.mean_mps, s.flapping.coning_rad/DEG,o.stalled_norm);
    }
    let i=inputs(589.0, 10.0*DEG); let (mut s,_)=settle(&p,&i);
    let t=std::time::Instant::now(); let n=200000; for _ in 0..n { s=std::hint::black_box(rotors::rotor(&p,&p.blade(),&s,&i)).0; } println!("{:.0} ns per rotor", t.elapsed().as_nanos() as f64/n as f64);
}
