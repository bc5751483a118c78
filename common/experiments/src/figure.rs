//! Figures as data; drawing them is the page's business.

/// A figure of the report.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Stands above it.
    pub title: String,
    /// Stands below it: the paper's figure that it redraws, and what to see.
    pub caption: String,
    /// What it shows.
    pub plot: Plot,
}

/// What a figure shows. Points that are not numbers break a line and are left out elsewhere.
#[derive(Clone, Debug, PartialEq)]
pub enum Plot {
    /// Lines over a common axis.
    Lines {
        /// The horizontal axis.
        x: Label,
        /// The vertical axis.
        y: Label,
        /// Later lines lie above earlier ones.
        lines: Vec<Line>,
    },
    /// Horizontal bars in groups.
    Bars(Bars),
    /// Points, and ellipses around where they should lie.
    Scatter {
        /// The horizontal axis.
        x: Label,
        /// The vertical axis.
        y: Label,
        /// The points.
        clouds: Vec<Cloud>,
        /// The bounds.
        ellipses: Vec<Ellipse>,
    },
}

/// What an axis shows, and its unit of measure.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// Such as `deformation about z`.
    pub text: String,
    /// Empty for a plain number.
    pub unit: String,
}

impl Label {
    /// A label.
    pub fn new(text: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { text: text.into(), unit: unit.into() }
    }
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    /// In the next colour: an estimate or an error.
    Solid,
    /// Dashed, black: the truth.
    Truth,
    /// Thin, grey: a bound or a range.
    Bound,
}

/// A line.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Its name in the legend; lines that share a name share colour and entry, as the two sides of a range do.
    pub name: String,
    /// How it is drawn.
    pub stroke: Stroke,
    /// In the order of x.
    pub points: Vec<(f64, f64)>,
}

/// Groups of bars.
#[derive(Clone, Debug, PartialEq)]
pub struct Bars {
    /// What the length of a bar shows.
    pub value: Label,
    /// Name of each group, such as a method.
    pub groups: Vec<String>,
    /// One bar a group each, such as an axis.
    pub series: Vec<Series>,
}

/// One bar a group.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Its name in the legend.
    pub name: String,
    /// By group: the bar's length, and its standard deviation, 0 or NaN for none.
    pub values: Vec<(f64, f64)>,
    /// By group: a mark on the bar, the bound; NaN for none. Empty for no marks at all.
    pub bounds: Vec<f64>,
}

/// Points of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Cloud {
    /// Their name in the legend.
    pub name: String,
    /// The true value is drawn as a black cross.
    pub truth: bool,
    /// Where they lie.
    pub points: Vec<(f64, f64)>,
    /// Standard deviation of each in y, drawn as an error bar; empty for none.
    pub sigma: Vec<f64>,
}

/// Where a share of the points should lie.
#[derive(Clone, Debug, PartialEq)]
pub struct Ellipse {
    /// Its name in the legend.
    pub name: String,
    /// Where it lies.
    pub centre: (f64, f64),
    /// Covariance xx, xy, yy.
    pub covariance: [f64; 3],
    /// How many standard deviations it is away from its centre: 2.45 holds 95 % of a plane's normal points.
    pub sigmas: f64,
}

impl Ellipse {
    /// Its outline, closed.
    pub fn outline(&self) -> Vec<(f64, f64)> {
        // the columns of the covariance's Cholesky factor turn the circle into the ellipse
        let [xx, xy, yy] = self.covariance;
        let a = xx.max(0.0).sqrt();
        let b = if a > 0.0 { xy / a } else { 0.0 };
        let c = (yy - b * b).max(0.0).sqrt();
        let point = |i: i32| {
            let (sine, cosine) = (f64::from(i) * std::f64::consts::TAU / 120.0).sin_cos();
            (self.centre.0 + self.sigmas * a * cosine, self.centre.1 + self.sigmas * (b * cosine + c * sine))
        };
        (0..=120).map(point).collect()
    }
}
