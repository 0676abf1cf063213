//! A still picture: bodies at one time, drawn in software without perspective.

use super::picture::{Picture, PictureBody, Up};
use super::{Flight, Mark};
use d2m::motion::RigidMotion;
use glam::DVec3;

/// Width and height of a picture in pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct StillSize {
    pub(crate) width: u32,
    pub(crate) height: u32,
}

impl StillSize {
    /// What screens and papers use; more would only fill memory.
    const MOST: u32 = 8192;

    /// Reads `WIDTHxHEIGHT`.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        let number = |text: &str| text.parse().ok().filter(|n| (1..=Self::MOST).contains(n));
        let sizes = text.split_once('x').and_then(|(w, h)| Some((number(w)?, number(h)?)));
        let (width, height) =
            sizes.ok_or_else(|| format!("{text:?} is not WIDTHxHEIGHT with 1 to {} pixels", Self::MOST))?;
        Ok(Self { width, height })
    }
}

/// Points of a pixel along each axis; their mean is what is shown.
const SAMPLES: usize = 2;
const BACKGROUND: [f32; 3] = [0.957, 0.961, 0.969];
const MARK: [f32; 3] = [0.878, 0.098, 0.353];
const COLORS: [u32; 8] = [0x3b6fb6, 0xd9822b, 0x4f9d69, 0xb0494f, 0x7a5ea8, 0x3f9aa0, 0xa88a3d, 0x6b7686];
/// Part of the picture that stays free at each edge.
const MARGIN: f64 = 0.06;

/// How one looks: two directions in the picture and the one towards the eye, orthonormal.
struct View {
    right: DVec3,
    up: DVec3,
    towards: DVec3,
    /// Samples per length, and the place of the world's origin.
    scale: f64,
    origin: [f64; 2],
}

/// Colors and depths of all samples.
struct Canvas {
    width: usize,
    height: usize,
    colors: Vec<[f32; 3]>,
    depths: Vec<f64>,
}

/// The picture at a time, as a PNG file.
pub(crate) fn still(picture: &Picture, time: f64, size: StillSize) -> Result<Vec<u8>, png::EncodingError> {
    let mut canvas = Canvas::new(size);
    let placed: Vec<Vec<DVec3>> = picture.bodies.iter().map(|body| placed(picture, body, time)).collect();
    let marks: Vec<&Mark> =
        picture.marks.iter().filter(|mark| mark.from <= time && time <= mark.until).collect();
    let view = View::new(picture.up, placed.iter().flatten(), &canvas);
    for (index, (body, points)) in picture.bodies.iter().zip(&placed).enumerate() {
        let hex = COLORS[index % COLORS.len()];
        let color = [16, 8, 0].map(|shift| (hex >> shift & 0xff) as f32 / 255.0);
        for triangle in &picture.meshes[body.mesh].triangles {
            canvas.triangle(&view, triangle.map(|i| points[i as usize]), color);
        }
    }
    for mark in marks {
        canvas.mark(&view, mark);
    }
    canvas.to_png(size)
}

/// The vertices of a body in the world.
fn placed(picture: &Picture, body: &PictureBody, time: f64) -> Vec<DVec3> {
    let mesh = &picture.meshes[body.mesh];
    let after = body.flights.partition_point(|flight| flight.start <= time);
    let flight: &Flight = match body.flights.get(after.max(1) - 1) {
        Some(flight) => flight,
        None => return vec![DVec3::ZERO; mesh.vertices.len()],
    };
    let (pose, _) = flight.motion.pose_and_twist(time.clamp(flight.start, flight.end));
    mesh.vertices.iter().map(|v| pose.transform_point(v.as_dvec3() + mesh.center)).collect()
}

impl View {
    /// From in front, to the right and above, so that all points are in the picture.
    fn new<'p>(up: Up, points: impl Iterator<Item = &'p DVec3>, canvas: &Canvas) -> Self {
        let (above, towards) = match up {
            Up::Y => (DVec3::Y, DVec3::new(0.6, 0.5, 1.0)),
            Up::Z => (DVec3::Z, DVec3::new(0.6, -1.0, 0.5)),
        };
        let towards = towards.normalize();
        let right = above.cross(towards).normalize();
        let up = towards.cross(right);
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for point in points {
            for (k, along) in [point.dot(right), point.dot(up)].into_iter().enumerate() {
                (low[k], high[k]) = (low[k].min(along), high[k].max(along));
            }
        }
        let size = [canvas.width as f64, canvas.height as f64];
        let fits = |k: usize| size[k] * (1.0 - 2.0 * MARGIN) / (high[k] - low[k]).max(f64::MIN_POSITIVE);
        let scale = fits(0).min(fits(1));
        let middle = [0, 1].map(|k| 0.5 * low[k] + 0.5 * high[k]);
        let origin = [0.5 * size[0] - scale * middle[0], 0.5 * size[1] + scale * middle[1]];
        Self { right, up, towards, scale, origin }
    }

    /// Across, down, and towards the eye.
    fn project(&self, p: DVec3) -> [f64; 3] {
        let [x, y] = [self.scale * p.dot(self.right), self.scale * p.dot(self.up)];
        [self.origin[0] + x, self.origin[1] - y, p.dot(self.towards)]
    }
}

impl Canvas {
    fn new(size: StillSize) -> Self {
        let (width, height) = (size.width as usize * SAMPLES, size.height as usize * SAMPLES);
        let count = width * height;
        Self { width, height, colors: vec![BACKGROUND; count], depths: vec![f64::NEG_INFINITY; count] }
    }

    /// The samples of rows and columns in a range, cut to the picture.
    fn range(most: usize, low: f64, high: f64) -> core::ops::Range<usize> {
        // Casts saturate; what is not a number is zero.
        (low.floor().max(0.0) as usize).min(most)..(high.ceil().max(0.0) as usize).min(most)
    }

    fn triangle(&mut self, view: &View, corners: [DVec3; 3], color: [f32; 3]) {
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or_zero();
        let light = (view.towards + 0.6 * view.up - 0.4 * view.right).normalize();
        let shade = (0.4 + 0.6 * normal.dot(light).abs()) as f32;
        let color = color.map(|c| c * shade);
        let [a, b, c] = corners.map(|p| view.project(p));
        let side = |p: [f64; 2], q: [f64; 3], r: [f64; 3]| {
            (r[0] - q[0]) * (p[1] - q[1]) - (r[1] - q[1]) * (p[0] - q[0])
        };
        let area = side([c[0], c[1]], a, b);
        if area == 0.0 || !area.is_finite() {
            return;
        }
        let least = |k: usize| a[k].min(b[k]).min(c[k]);
        let most = |k: usize| a[k].max(b[k]).max(c[k]);
        for row in Self::range(self.height, least(1), most(1)) {
            for column in Self::range(self.width, least(0), most(0)) {
                let p = [column as f64 + 0.5, row as f64 + 0.5];
                let weights = [side(p, b, c), side(p, c, a), side(p, a, b)].map(|w| w / area);
                let depth = weights[0] * a[2] + weights[1] * b[2] + weights[2] * c[2];
                let place = row * self.width + column;
                if weights.iter().all(|&w| w >= 0.0) && depth > self.depths[place] {
                    self.depths[place] = depth;
                    self.colors[place] = color;
                }
            }
        }
    }

    /// A dot at the contact and a line along its normal, over everything else.
    fn mark(&mut self, view: &View, mark: &Mark) {
        let size = self.width.min(self.height) as f64;
        let [x, y, _] = view.project(mark.points[0]);
        let towards = view.project(mark.points[0] + mark.normal / view.scale);
        let (along_x, along_y) = (towards[0] - x, towards[1] - y);
        self.dot([x, y], 0.009 * size);
        const STEPS: u32 = 400;
        for step in 0..=STEPS {
            let far = 0.1 * size * f64::from(step) / f64::from(STEPS);
            self.dot([x + along_x * far, y + along_y * far], 0.003 * size);
        }
    }

    fn dot(&mut self, [x, y]: [f64; 2], radius: f64) {
        for row in Self::range(self.height, y - radius, y + radius) {
            for column in Self::range(self.width, x - radius, x + radius) {
                let [dx, dy] = [column as f64 + 0.5 - x, row as f64 + 0.5 - y];
                if dx * dx + dy * dy <= radius * radius {
                    self.colors[row * self.width + column] = MARK;
                }
            }
        }
    }

    fn to_png(&self, size: StillSize) -> Result<Vec<u8>, png::EncodingError> {
        let mut pixels = Vec::with_capacity(3 * size.width as usize * size.height as usize);
        for row in 0..size.height as usize {
            for column in 0..size.width as usize {
                for k in 0..3 {
                    let mut sum = 0.0;
                    for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                        sum += self.colors[(row * SAMPLES + i) * self.width + column * SAMPLES + j][k];
                    }
                    pixels.push((255.0 * sum / (SAMPLES * SAMPLES) as f32).round() as u8);
                }
            }
        }
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, size.width, size.height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&pixels)?;
        writer.finish()?;
        Ok(file)
    }
}
