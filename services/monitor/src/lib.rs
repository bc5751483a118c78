//! `deckflex monitor`: a page in the terminal that looks at a running launch.

mod draw;
mod marks;
mod page;
mod ports;
mod strip;
mod words;
mod zeros;

pub use draw::draw;
pub use page::{AreaState, Delays, Link, Page, Past, StageState};

use pipeline::configuration::ConfigurationError;
use pipeline::zero::Zero;
use ports::Ports;
use ratatui::crossterm::event::{self, Event, KeyCode, KeyEventKind, KeyModifiers};
use runtime::{Lookout, Stop, TransportError, monotonic_ns};
use std::io::{self, IsTerminal};
use std::path::PathBuf;
use std::time::Duration;
use zeros::{Place, ZeroError};

/// What the user asks for.
#[derive(Clone, Debug)]
pub struct Options {
    /// The configuration whose launch is looked at; `None` for the one that runs.
    pub configuration: Option<PathBuf>,
    /// Where marked events go.
    pub events: PathBuf,
    /// Where it is told which zeros were taken.
    pub zeros: PathBuf,
}

/// Why there is no page.
#[derive(Debug, thiserror::Error)]
pub enum MonitorError {
    /// The transport refuses.
    #[error(transparent)]
    Transport(#[from] TransportError),
    /// The configuration cannot be used.
    #[error(transparent)]
    Configuration(#[from] ConfigurationError),
    /// There is no terminal to draw on.
    #[error("monitor draws a page and needs a terminal; the numbers are in the files of `launch --out`")]
    NoTerminal,
    /// The terminal does not answer.
    #[error("the terminal cannot be used: {0}")]
    Terminal(#[from] io::Error),
}

/// The page is drawn at least so often.
const REFRESH: Duration = Duration::from_millis(200);
/// A launch is looked for, and its life checked, so often, ns.
const LOOK_NS: i64 = 1_000_000_000;

/// Shows the page until the user leaves.
///
/// # Errors
/// There is no terminal, or the configuration cannot be read.
pub fn run(options: &Options) -> Result<(), MonitorError> {
    if !io::stdout().is_terminal() {
        return Err(MonitorError::NoTerminal);
    }
    if let Some(path) = &options.configuration {
        pipeline::configuration::Configuration::read(path)?;
    }
    let stop = Stop::install()?;
    let mut terminal = ratatui::try_init()?;
    let shown = show(options, &stop, &mut terminal);
    ratatui::try_restore()?;
    shown
}

fn show(options: &Options, stop: &Stop, terminal: &mut ratatui::DefaultTerminal) -> Result<(), MonitorError> {
    let lookout = Lookout::new(options.configuration.as_deref());
    let mut watch =
        Watch { options, page: Page::waiting(waiting(options)), ports: None, lookout, looked_ns: 0, asked: None };
    while !stop.requested() {
        watch.update(monotonic_ns());
        terminal.draw(|frame| draw(frame, &watch.page, monotonic_ns()))?;
        if event::poll(REFRESH)? && watch.left(&event::read()?) {
            break;
        }
    }
    Ok(())
}

fn waiting(options: &Options) -> String {
    let command = match &options.configuration {
        Some(path) => format!("deckflex launch {}", path.display()),
        None => "deckflex launch CONFIG".to_owned(),
    };
    format!(
        "No launch of this user runs now. Start one in another terminal: {command}. This page shows it as soon as it is there."
    )
}

struct Watch<'a> {
    options: &'a Options,
    page: Page,
    ports: Option<Ports>,
    lookout: Lookout,
    looked_ns: i64,
    /// The zero that waits for a yes, with the area's index.
    asked: Option<(usize, Zero)>,
}

impl Watch<'_> {
    /// Takes in what has come. A launch that ends is waited for anew; its last page stays until the next one.
    fn update(&mut self, now_ns: i64) {
        let failed = match &self.ports {
            Some(ports) => ports.drain(&mut self.page).err().map(|error| error.to_string()),
            None => None,
        };
        if failed.is_none() && now_ns - self.looked_ns < LOOK_NS {
            return;
        }
        self.looked_ns = now_ns;
        match &self.ports {
            Some(ports) if failed.is_none() && ports.is_alive() => {}
            Some(_) => {
                (self.ports, self.asked) = (None, None);
                let reason =
                    failed.map_or("The launch has ended.".to_owned(), |error| format!("Lost the launch: {error}."));
                self.page = Page::waiting(format!("{reason} {}", waiting(self.options)));
            }
            None => self.attach(),
        }
    }

    fn attach(&mut self) {
        match self.lookout.look() {
            Ok(Some(launch)) => match Ports::open(&launch) {
                Ok((ports, page)) => (self.ports, self.page) = (Some(ports), page),
                Err(error) => self.page = Page::waiting(format!("Cannot attach to the launch: {error}.")),
            },
            Ok(None) => {}
            Err(error) => self.page = Page::waiting(format!("Cannot look for launches: {error}.")),
        }
    }

    /// Carries out a key; `true` for the one that leaves.
    fn left(&mut self, event: &Event) -> bool {
        let Event::Key(key) = event else { return false };
        if key.kind != KeyEventKind::Press {
            return false;
        }
        let asked = self.asked.take();
        match key.code {
            KeyCode::Char('y') if asked.is_some() => asked.iter().for_each(|(area, zero)| self.zero(*area, zero)),
            _ if asked.is_some() => self.page.note = "no zero was taken".to_owned(),
            KeyCode::Char('q') | KeyCode::Esc => return true,
            KeyCode::Char('c') if key.modifiers.contains(KeyModifiers::CONTROL) => return true,
            KeyCode::Tab => self.page.next_area(),
            KeyCode::Char('e') => self.mark(),
            KeyCode::Char('z') => self.ask(),
            _ => {}
        }
        false
    }

    /// Asks whether the mean of the last minute is to be told as none.
    fn ask(&mut self) {
        let Some(area) = self.page.area() else { return };
        let found = match &self.ports {
            Some(ports) if ports.configuration().is_some() => area.minute.zero().map_err(ZeroError::from),
            _ => Err(ZeroError::Recorded),
        };
        self.page.note = match &found {
            Ok(zero) => {
                let [x, y, z] = zero.value.array().map(|x| x / frames::unit::DEGREE);
                format!("zero {} at {x:+.3}, {y:+.3}, {z:+.3} degrees? y writes it", area.name)
            }
            Err(error) => error.to_string(),
        };
        self.asked = found.ok().map(|zero| (self.page.shown, zero));
    }

    fn zero(&mut self, area: usize, zero: &Zero) {
        let configuration = self.ports.as_ref().and_then(Ports::configuration);
        let Some(((area, last), configuration)) =
            self.page.areas.get(area).and_then(|area| Some((&area.name, area.last.as_ref()?))).zip(configuration)
        else {
            return;
        };
        let place = Place { configuration, zeros: &self.options.zeros, area };
        self.page.note = match place.write(zero, last) {
            Ok(()) => "written; the zero takes effect when the launch is started again".to_owned(),
            Err(error) => error.to_string(),
        };
    }

    fn mark(&mut self) {
        let Some((area, last)) = self.page.area().and_then(|area| Some((area.name.clone(), area.last?))) else {
            self.page.note = "nothing to mark yet".to_owned();
            return;
        };
        let path = self.options.events.as_path();
        self.page.note = match marks::mark(path, &area, &last) {
            Ok(()) => format!("marked {:.1} s", frames::unit::seconds(last.header.time_ns)),
            Err(error) => format!("cannot write {}: {error}", path.display()),
        };
    }
}
