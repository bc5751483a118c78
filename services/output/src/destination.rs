use crate::OutputError;
use crate::clock::Clock;
use crate::line::Line;
use frames::unit::nanoseconds;
use messages::{Header, OutputState, Solution};
use pipeline::configuration::{Configuration, Output, Telegrams};
use runtime::{Latency, Throttle, monotonic_ns};
use telegrams::{Cadence, Report, Track, encode_kmb, instant_ns};

/// The least difference that shows in a sentence.
const MILLISECOND_NS: i64 = 1_000_000;

/// One destination: what has gone there and what is due.
pub struct Destination {
    output: Output,
    area: usize,
    lead_ns: i64,
    silence_ns: i64,
    period_ns: i64,
    cadence: Cadence,
    line: Line,
    state: OutputState,
    delays: Latency,
    text: String,
    /// Of the last solution: what is told of silence has none of its own.
    zero: Option<[f64; 3]>,
    last_utc_ns: i64,
    /// When the next word about silence is due, on the monotonic clock.
    due_ns: i64,
    logged: Logged,
}

/// Whether it takes telegrams, as the log has it.
struct Logged {
    open: bool,
    throttle: Throttle,
}

impl Destination {
    /// Opens a destination of the configuration. With `resume` a line that cannot be opened now is opened later.
    pub fn open(configuration: &Configuration, number: usize, run_id: u64, resume: bool) -> Result<Self, OutputError> {
        let output = configuration.outputs[number].clone();
        let mut line = Line::new(output.to.clone());
        match line.open() {
            Err(reason) if !resume => {
                return Err(OutputError::Destination { number, to: output.to.to_string(), reason });
            }
            _ => {}
        }
        let area = configuration.areas.iter().position(|area| area.name == output.area).unwrap_or(0);
        let rate_hz = output.rate_hz.min(configuration.rate_hz);
        Ok(Self {
            area,
            lead_ns: nanoseconds(output.extrapolate_s),
            silence_ns: nanoseconds(output.silence_s),
            period_ns: nanoseconds(1.0 / rate_hz),
            cadence: Cadence::new(rate_hz, configuration.rate_hz),
            line,
            state: OutputState {
                header: Header { run_id, ..Header::default() },
                output: number as u32,
                area: area as u32,
                ..OutputState::default()
            },
            delays: Latency::new(),
            text: String::with_capacity(output.longest(true)),
            zero: None,
            last_utc_ns: i64::MIN,
            due_ns: monotonic_ns() + nanoseconds(output.silence_s),
            logged: Logged { open: true, throttle: Throttle::default() },
            output,
        })
    }

    /// Index of its area.
    pub fn area(&self) -> usize {
        self.area
    }

    pub fn counts(&self) -> &OutputState {
        &self.state
    }

    /// Tells a solution, if its turn has come and it is young enough.
    pub fn tell(&mut self, solution: &Solution, track: &Track, clock: &Clock) {
        if !self.cadence.takes(solution.header.time_ns) {
            return;
        }
        if monotonic_ns() - instant_ns(&solution.header) > self.silence_ns {
            self.state.withheld += 1;
            return;
        }
        let moment = track.moment(solution, self.lead_ns);
        self.zero = moment.zero;
        if self.send(&moment.report(clock.utc_ns(moment.instant_ns))) {
            self.state.extrapolated += u64::from(moment.extrapolated);
            self.state.header.sequence = solution.header.sequence;
            self.state.header.time_ns = solution.header.time_ns;
            self.state.header.clock_domain = solution.header.clock_domain;
            self.delays.record(monotonic_ns() - solution.header.stamps.solution_ns);
        }
    }

    /// Says at the destination's rate that nothing is valid, when the newest solution is too old; sends what a slow line has left.
    pub fn attend(&mut self, newest_ns: i64, now_ns: i64, clock: &Clock) {
        self.line.attend(now_ns);
        if now_ns - newest_ns <= self.silence_ns {
            self.due_ns = newest_ns + self.silence_ns;
        } else if now_ns >= self.due_ns {
            self.send(&self.invalid(now_ns, clock));
            // after a pause of the process there is nothing to catch up with
            self.due_ns = (self.due_ns + self.period_ns).max(now_ns);
        }
    }

    /// Tells when the line has been lost or has come back.
    pub fn log(&mut self, now_ns: i64) {
        let open = self.line.is_open();
        if open != self.logged.open && self.logged.throttle.pass(now_ns) {
            self.logged.open = open;
            let (to, area, unsendable) = (&self.output.to, &self.output.area, self.state.unsendable);
            match open {
                true => tracing::info!(%to, of_area = area, unsendable, "a line takes telegrams again"),
                false => tracing::warn!(%to, of_area = area, unsendable, "a line does not take telegrams"),
            }
        }
    }

    /// The last word, later than even an attitude that was carried forward.
    pub fn end(&mut self, now_ns: i64, clock: &Clock) {
        let mut report = self.invalid(now_ns, clock);
        report.utc_ns = report.utc_ns.max(self.last_utc_ns.saturating_add(MILLISECOND_NS));
        self.send(&report);
        self.line.attend(now_ns);
    }

    /// When the next word about silence is due unless a solution comes, on the monotonic clock.
    pub fn due_ns(&self) -> i64 {
        self.due_ns
    }

    /// Sends a report, unless its instant is not later than that of the one before.
    fn send(&mut self, report: &Report) -> bool {
        if report.utc_ns <= self.last_utc_ns {
            self.state.withheld += 1;
            return false;
        }
        self.last_utc_ns = report.utc_ns;
        let sent = match &self.output.telegrams {
            Telegrams::Kmb => self.line.send(&encode_kmb(report)),
            Telegrams::Sentences(sentences) => {
                self.text.clear();
                let style = self.output.style();
                sentences.iter().for_each(|sentence| sentence.write(report, &style, &mut self.text));
                self.line.send(self.text.as_bytes())
            }
        };
        if sent {
            self.state.sent += 1;
            self.state.invalid += u64::from(report.attitude.is_none());
            self.state.zeroed += u64::from(report.zero.is_some());
        } else {
            self.state.unsendable += 1;
        }
        sent
    }

    fn invalid(&self, now_ns: i64, clock: &Clock) -> Report {
        Report { utc_ns: clock.utc_ns(now_ns), zero: self.zero, ..Report::default() }
    }

    /// The state to be published.
    pub fn state(&self, clock: &Clock, now_ns: i64) -> OutputState {
        let delays = self.delays.summary();
        let ns = |us: f64| (us * 1e3) as i64;
        OutputState {
            utc_offset_ns: clock.utc_ns(now_ns) - now_ns,
            utc_age_ns: clock.age_ns(now_ns),
            utc_error_ns: clock.error_ns().unwrap_or(-1),
            utc_ahead_ns: clock.ahead_ns(now_ns),
            delay_p50_ns: ns(delays.p50_us),
            delay_p99_ns: ns(delays.p99_us),
            delay_max_ns: ns(delays.max_us),
            utc_source: clock.source() as u32,
            open: u32::from(self.line.is_open()),
            ..self.state
        }
    }
}
