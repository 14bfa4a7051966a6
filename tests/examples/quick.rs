use darboux::*;
use mikktspace_sys::{MikkTSpaceInterface, gen_tang_space};
use std::time::Instant;
type V = (Vec<[f32; 3]>, Vec<[f32; 3]>, Vec<[f32; 2]>, Vec<u32>);
fn grid(n: usize, m: usize) -> V {
    let (mut p, mut nn, mut u, mut t) = (vec![], vec![], vec![], vec![]);
    for j in 0..=m {
        for i in 0..=n {
            let (x, y) = (i as f32 / n as f32, j as f32 / m as f32);
            let z = 0.1 * (6.0 * x).sin() * (5.0 * y).cos();
            let (dx, dy) =
                (0.6 * (6.0 * x).cos() * (5.0 * y).cos(), -0.5 * (6.0 * x).sin() * (5.0 * y).sin());
            let l = (dx * dx + dy * dy + 1.0f32).sqrt();
            p.push([x, y, z]);
            nn.push([-dx / l, -dy / l, 1.0 / l]);
            u.push([x + 0.01 * (9.0 * y).sin(), y]);
        }
    }
    for j in 0..m {
        for i in 0..n {
            let a = (j * (n + 1) + i) as u32;
            let (b, c, d) = (a + 1, a + n as u32 + 2, a + n as u32 + 1);
            t.extend([a, b, c, a, c, d]);
        }
    }
    (p, nn, u, t)
}
fn sphere(n: usize, m: usize) -> V {
    let (mut p, mut nn, mut u, mut t) = (vec![], vec![], vec![], vec![]);
    for j in 0..=m {
        for i in 0..=n {
            let (a, b) = (i as f32 / n as f32, j as f32 / m as f32);
            let (ph, th) = (a * std::f32::consts::TAU, b * std::f32::consts::PI);
            let ph = if i == n { 0.0 } else { ph };
            let st = if j == 0 || j == m { 0.0 } else { th.sin() };
            let v = [st * ph.cos(), st * ph.sin(), th.cos()];
            p.push(v);
            nn.push(v);
            u.push([a, b]);
        }
    }
    for j in 0..m {
        for i in 0..n {
            let a = (j * (n + 1) + i) as u32;
            let (b, c, d) = (a + 1, a + n as u32 + 2, a + n as u32 + 1);
            t.extend([a, c, b, a, d, c]);
        }
    }
    (p, nn, u, t)
}
fn soup(v: &V) -> V {
    let g = |i: &u32| *i as usize;
    (
        v.3.iter().map(|i| v.0[g(i)]).collect(),
        v.3.iter().map(|i| v.1[g(i)]).collect(),
        v.3.iter().map(|i| v.2[g(i)]).collect(),
        vec![],
    )
}
fn charts(count: usize) -> V {
    let (mut p, mut nn, mut u, mut tr) = (vec![], vec![], vec![], vec![]);
    let mut seed = 12345u64;
    let mut rnd = move || {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 33) as usize
    };
    for c in 0..count {
        let base = p.len() as u32;
        let g = grid(5, 5);
        let off = [(c % 141) as f32 * 1.1, (c / 141) as f32 * 1.1, 0.0];
        let m = c % 2 == 1;
        for i in 0..g.0.len() {
            p.push([g.0[i][0] + off[0], g.0[i][1] + off[1], g.0[i][2]]);
            nn.push(g.1[i]);
            u.push([if m { -g.2[i][0] } else { g.2[i][0] }, g.2[i][1]]);
        }
        for t in g.3.chunks(3) {
            tr.push([t[0] + base, t[1] + base, t[2] + base]);
        }
    }
    for i in (1..tr.len()).rev() {
        tr.swap(i, rnd() % (i + 1));
    }
    let mut perm: Vec<u32> = (0..p.len() as u32).collect();
    for i in (1..perm.len()).rev() {
        perm.swap(i, rnd() % (i + 1));
    }
    let (mut p2, mut n2, mut u2) = (p.clone(), nn.clone(), u.clone());
    for i in 0..p.len() {
        let d = perm[i] as usize;
        p2[d] = p[i];
        n2[d] = nn[i];
        u2[d] = u[i];
    }
    (p2, n2, u2, tr.iter().flat_map(|t| t.map(|i| perm[i as usize])).collect())
}
struct C<'a>(&'a V, Vec<[f32; 4]>);
impl C<'_> {
    fn v(&self, f: usize, c: usize) -> usize {
        if self.0.3.is_empty() { 3 * f + c } else { self.0.3[3 * f + c] as usize }
    }
}
impl MikkTSpaceInterface for C<'_> {
    fn get_num_faces(&self) -> usize {
        self.1.len() / 3
    }
    fn get_num_vertices_of_face(&self, _: usize) -> usize {
        3
    }
    fn get_position(&self, f: usize, c: usize) -> [f32; 3] {
        self.0.0[self.v(f, c)]
    }
    fn get_normal(&self, f: usize, c: usize) -> [f32; 3] {
        self.0.1[self.v(f, c)]
    }
    fn get_tex_coord(&self, f: usize, c: usize) -> [f32; 2] {
        self.0.2[self.v(f, c)]
    }
    fn set_tspace_basic(&mut self, t: [f32; 3], s: f32, f: usize, c: usize) {
        self.1[3 * f + c] = [t[0], t[1], t[2], s];
    }
}
fn run() {
    let args: Vec<String> = std::env::args().collect();
    let want = |n: &str| args.len() < 2 || args[1].split(',').any(|a| n.starts_with(a));
    let reps: usize = args.get(2).map_or(7, |a| a.parse().unwrap());
    let noref = args.get(3).is_some();
    let limit = match std::env::var("W").as_deref() {
        Ok("0") => WidthLimit::Compiled,
        Ok("1") => WidthLimit::Bits256,
        _ => WidthLimit::Bits512,
    };
    let mut meshes: Vec<(&str, V)> = vec![];
    if want("small") {
        meshes.push(("small", grid(50, 50)));
    }
    if want("mid") {
        meshes.push(("mid", grid(158, 158)));
    }
    if want("grid") {
        meshes.push(("grid", grid(707, 707)));
    }
    if want("sphere") {
        meshes.push(("sphere", sphere(1000, 500)));
    }
    if want("soup") {
        meshes.push(("soup", soup(&grid(707, 707))));
    }
    if want("charts") {
        meshes.push(("charts", charts(20000)));
    }
    if let Some(path) = args.get(1).filter(|a| a.contains('/')) {
        let mut doc =
            darboux_io::gltf::Document::open(std::path::Path::new(path), &Default::default()).unwrap();
        doc.decompress().unwrap();
        for m in doc.meshes() {
            for pr in &m.primitives {
                let a = |s: &str| pr.attributes.get(s).copied();
                let (Some(p), Some(n), Some(u)) = (a("POSITION"), a("NORMAL"), a("TEXCOORD_0")) else {
                    continue;
                };
                let Some(i) = pr.indices else { continue };
                meshes.push((
                    "model",
                    (
                        doc.read_vectors(p).unwrap(),
                        doc.read_vectors(n).unwrap(),
                        doc.read_vectors(u).unwrap(),
                        doc.read_indices(i).unwrap(),
                    ),
                ));
            }
        }
    }
    for (name, v) in &meshes {
        let idx = if v.3.is_empty() { Indices::Unindexed } else { Indices::U32(&v.3) };
        let mesh = Mesh::triangles(&v.0, &v.1, &v.2, idx).unwrap();
        let n = mesh.face_count() as f64;
        if n < 1000.0 {
            continue;
        }
        let mut scratch = Scratch::with_width_limit(limit);
        let mut out = Tangents::default();
        let opt = TangentOptions { mode: Mode::Reference, ..Default::default() };
        let (mut r, mut o) = (vec![], vec![]);
        for k in 0..reps {
            if !noref {
                let mut c = C(v, vec![[0.0; 4]; mesh.corner_count()]);
                let t = Instant::now();
                gen_tang_space(&mut c, 180.0);
                r.push(t.elapsed().as_secs_f64() * 1e9 / n);
                if k == 0 {
                    generate_tangents_into(&mesh, &opt, &mut scratch, &mut out);
                    let d =
                        c.1.iter()
                            .zip(out.corners.per_corner())
                            .filter(|(a, b)| a.map(f32::to_bits) != b.map(f32::to_bits))
                            .count();
                    if d > 0 {
                        println!("DIFFER {d}");
                    }
                }
            }
            let inner = if n < 60000.0 { 50 } else { 1 };
            let t = Instant::now();
            for _ in 0..inner {
                generate_tangents_into(&mesh, &opt, &mut scratch, &mut out);
            }
            o.push(t.elapsed().as_secs_f64() * 1e9 / n / inner as f64);
        }
        r.sort_by(f64::total_cmp);
        o.sort_by(f64::total_cmp);
        let (rm, om) = (r.get(reps / 2).copied().unwrap_or(0.0), o[reps / 2]);
        println!(
            "{name:8} {n:9} tris: ref {:.0}/{rm:.0}  ours {:.1}/{om:.1}  ratio {:.1}  {:?}",
            r.first().unwrap_or(&0.0),
            o[0],
            rm / om,
            out.report
        );
    }
}
fn main() {
    let n = std::env::var("T").map_or(1, |t| t.parse().unwrap());
    rayon::ThreadPoolBuilder::new().num_threads(n).stack_size(1 << 30).build().unwrap().install(run)
}
