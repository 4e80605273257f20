#[path = "rotor_lab.rs"] #[allow(dead_code)] mod lab;
use engine::math::*; use engine::frames::Vec3; use engine::rotors::{self,*};
const DEG:f64=PI/180.0;
fn main() {
    let x = aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap(); let p=&x.rotors;
    let om=768.0/12.5; let tip=om*p.radius_m;
    for (mu, pub_) in [(0.125,[0.00570,0.00355,0.00130]),(0.15,[0.00595,0.00330,0.00075]),(0.17,[0.00620,0.00310,0.00035]),(0.20,[0.00665,0.00295,0.0])] {
      for (k,a) in [-15.0f64,0.0,15.0].iter().enumerate() {
        // mu = V cos a/tip? use V/tip
        let v=mu*tip; let al=a*DEG;
        let mut i=lab::inputs(om*30.0/PI, 8.0*DEG);
        i.motion.airspeed_mps=Vec3::new(v*cos(al),0.0,v*sin(al)); // alpha negative: climb => z negative
        let mut s=State::default(); let mut o=Outputs::default();
        for _ in 0..20000 { let r=rotors::rotor(p,&p.blade(),&s,&i); s=r.0; o=r.1;
          i.cyclic_forward_rad += 0.002*o.tilt_aft_rad; i.cyclic_outboard_rad -= 0.002*o.tilt_outboard_rad;
          i.collective_rad += 0.01*(0.075-o.blade_loading); }
        let cq=o.torque_n_m/(1.225*p.disc_area_m2()*tip*tip*p.radius_m)/p.solidity;
        println!("mu {mu} a {a:5} CT/s {:.4} CQ/s {cq:.5} pub {:.5} diff {:+.5} coll {:.2} B1 {:.2} A1 {:.2} tilt {:.3} {:.3} v0 {:.2} vc {:.2} vs {:.2}", o.blade_loading, pub_[k], cq-pub_[k], i.collective_rad/DEG, i.cyclic_forward_rad/DEG, i.cyclic_outboard_rad/DEG, o.tilt_aft_rad/DEG,o.tilt_outboard_rad/DEG, s.inflow.mean_mps,s.inflow.aft_mps,s.inflow.right_mps);
    }}
    // flapping without cyclic at 40..100kt
    for kt in [20.0,40.0,60.0,80.0] { for a1 in [0.0,-4.0,4.0] {
        let mut i=lab::inputs(589.0, 9.0*DEG); i.motion.airspeed_mps=Vec3::new(kt*0.5144,0.0,0.0); i.cyclic_outboard_rad=a1*DEG;
        let mut s=State::default(); let mut o=Outputs::default();
        for _ in 0..5000 { let r=rotors::rotor(p,&p.blade(),&s,&i); s=r.0; o=r.1; }
        println!("{kt} kt A1 {a1}: tilt aft {:.2} right {:.2} cone {:.2} CT/s {:.4}", o.tilt_aft_rad/DEG,o.tilt_outboard_rad/DEG,o.coning_rad/DEG,o.blade_loading);
    }}
    // airplane
    for (v,rpm) in [(71.9,458.0),(92.4,458.0),(113.1,458.0),(154.3,458.0),(92.4,589.0)] {
        let mut i=lab::inputs(rpm, 40.0*DEG); i.mast_tilt_rad=PI/2.0; i.motion.airspeed_mps=Vec3::new(v,0.0,0.0);
        let t_target = 0.5*1.225*v*v*0.93/2.0 + if v<95.0 {1500.0} else {500.0};
        let mut s=State::default(); let mut o=Outputs::default();
        for _ in 0..20000 { let r=rotors::rotor(p,&p.blade(),&s,&i); s=r.0; o=r.1; i.collective_rad += 1e-8*(t_target-o.thrust_n); }
        println!("plane V {v} rpm {rpm} T {:.0} coll {:.2} (root-lin eq {:.2}) P2 {:.0} kW eta {:.3} v0 {:.2} stall {:.2}", o.thrust_n, i.collective_rad/DEG, i.collective_rad/DEG+30.75, 2e-3*o.power_w, o.thrust_n*v/o.power_w, s.inflow.mean_mps, o.stalled_norm);
    }
}
