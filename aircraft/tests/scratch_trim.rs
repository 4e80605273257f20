use engine::frames::{Attitude, Euler, Vec3};
use engine::math::PI;
use engine::pair::Pair;
use engine::*;
const DEG: f64 = PI/180.0;
fn eval(x: &Aircraft, s0: &State, v: f64, tilt: f64, rpm: f64, flap: f64, u: [f64;3]) -> ([f64;3], Outputs) {
    let mut s = *s0;
    let (th, fwd_in, coll) = (u[0], u[1], u[2]);
    let fwd = fwd_in*0.0254;
    let mut out = Outputs::default();
    for _ in 0..400 {
        s.actuators.collective_rad = Pair::both(coll);
        s.actuators.cyclic_forward_rad = Pair::both(x.fcc.mixer.cyclic_per_longitudinal_stick_rad_per_m.at(tilt)*fwd);
        s.actuators.elevator_rad = x.fcc.mixer.elevator_per_longitudinal_stick_rad_per_m*fwd;
        s.actuators.flap_rad = flap;
        s.actuators.mast_tilt_rad = Pair::both(tilt);
        s.actuators.gear_extension_norm = 0.0;
        s.fcc.governor.correction_rad = coll; s.fcc.governor.integral_rad = coll;
        s.cockpit.scas_on=0;
        s.cockpit.gear_down=0;
        s.cockpit.stick_aft_norm = -fwd_in/4.8;
        s.cockpit.flap_detent = if flap > 1.0 {3} else if flap>0.5 {2} else if flap>0.2 {1} else {0};
        s.plant.attitude = Attitude::from_euler(Euler{pitch_rad: th, ..Default::default()});
        s.plant.velocity_mps = Vec3::new(v,0.0,0.0);
        s.plant.position_m = Vec3::new(0.0,0.0,-20.0);
        s.plant.angular_rate_radps = Vec3::zero();
        s.plant.rotor_speed_radps = rpm*PI/30.0;
        s.plant.engines = s.plant.engines.map(|mut e| { e.power_w = out.rotors.map(|r| r.power_w).mean(); e });
        let (n, o) = step(x, &s, &Inputs{events:&[], world: Default::default()});
        s = n; out = o;
    }
    let nb = Attitude::from_euler(Euler{pitch_rad: th, ..Default::default()}).ned_from_body();
    let f = nb*out.total.force_n;
    ([f.x/5900.0, f.z/5900.0+9.80665, out.total.moment_n_m.y/29000.0], out)
}
#[test]
fn trim() {
    let mut x = aircraft::aircraft("x", aircraft::XV15).unwrap();
    x.fcc.mixer.flap_rad = x.fcc.mixer.flap_rad;
    let start = aircraft::start("d", aircraft::DEFAULT_SCENARIO).unwrap();
    let s0 = start.state(&x);
    for (b, rpm, flap, vs, th0) in [(0.0,589.0,40.0,vec![0.1,10.5,20.6,31.0,41.2,51.4],14.0),(30.0,589.0,20.0,vec![41.1,61.7],15.0),(60.0,589.0,20.0,vec![51.5,72.3],22.0),(90.0,458.0,0.0,vec![52.0,71.9,92.4,113.1,132.7],35.0),(90.0,517.0,0.0,vec![71.9,92.4,113.1],35.0)] {
        let mut u=[0.0,0.3,th0*DEG];
        for v in vs {
            for _ in 0..25 {
                let (r,_) = eval(&x,&s0,v,b*DEG,rpm,flap*DEG,u);
                let d=[1e-3,1e-2,1e-3];
                let mut j=[[0.0;3];3];
                for k in 0..3 { let mut w=u; w[k]+=d[k]; let (q,_)=eval(&x,&s0,v,b*DEG,rpm,flap*DEG,w); for i in 0..3 { j[i][k]=(q[i]-r[i])/d[k]; } }
                let m = engine_solve(j,r);
                let lim=[0.05,1.0,0.05];
                for k in 0..3 { u[k]-=m[k].clamp(-lim[k],lim[k]); }
                if r.iter().all(|e| e.abs()<1e-4) {break;}
            }
            let (r,o)=eval(&x,&s0,v,b*DEG,rpm,flap*DEG,u);
            println!("bm {b} rpm {rpm} v {v:.1} theta {:.2} stick% {:.1} coll {:.2} P {:.0} kW fuel {:.0} T {:.0} lb CLs wing {:.0} fus {:.0} tail {:.0} res {:.0e}", u[0]/DEG, 50.0+u[1]/9.6*100.0, u[2]/DEG, o.rotors.map(|r| r.power_w).sum()/1e3, o.engines.fuel_flow_kg_per_s*3600.0/0.4536, o.rotors.map(|r| r.thrust_n).sum()/4.448, o.loads.wing_pylon.map(|l| l.force_n.z).sum()/4.448,o.loads.fuselage.force_n.z/4.448,o.loads.horizontal_stabilizer.force_n.z/4.448, r[0].abs()+r[1].abs()+r[2].abs());
        }
    }
}
fn engine_solve(mut a: [[f64;3];3], mut b:[f64;3])->[f64;3]{
    for i in 0..3 { let mut p=i; for r in i..3 { if a[r][i].abs()>a[p][i].abs() {p=r;} } a.swap(i,p); b.swap(i,p);
        for r in i+1..3 { let f=a[r][i]/a[i][i]; for c in i..3 { a[r][c]-=f*a[i][c]; } b[r]-=f*b[i]; } }
    let mut x=[0.0;3];
    for i in (0..3).rev() { let mut s=b[i]; for c in i+1..3 { s-=a[i][c]*x[c]; } x[i]=s/a[i][i]; }
    x
}
