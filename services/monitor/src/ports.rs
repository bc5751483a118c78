//! The page's readers in the domain of a launch.

use crate::MonitorError;
use crate::page::Page;
use messages::{FlexureParams, Health, Solution, topic};
use pipeline::configuration::Configuration;
use runtime::{Domain, Launch, Node, Subscriber, TransportError, monotonic_ns};
use std::path::Path;

/// The readers.
pub struct Ports {
    launch: Launch,
    recorded: bool,
    areas: Vec<(Subscriber<Solution>, Subscriber<FlexureParams>)>,
    health: Vec<Subscriber<Health>>,
    _node: Node,
}

impl Ports {
    /// Opens the readers of a launch, and its empty page.
    ///
    /// # Errors
    /// The launch's configuration cannot be read any more, or the transport refuses.
    pub fn open(launch: &Launch) -> Result<(Self, Page), MonitorError> {
        let configuration = Configuration::read(&launch.configuration)?;
        let source = configuration.main.source.stage();
        let names: Vec<&str> = configuration.areas.iter().map(|area| area.name.as_str()).collect();
        let title = launch.configuration.file_name().map_or(String::new(), |name| name.to_string_lossy().into_owned());
        let page = Page::attached(title, configuration.rate_hz, &names, source);
        let domain = Domain::open(&launch.root)?;
        let node = Node::open(&domain, "monitor")?;
        let of_area = |name: &&str| -> Result<_, TransportError> {
            Ok((Subscriber::open(&node, &topic::solution(name))?, Subscriber::open(&node, &topic::parameters(name))?))
        };
        let areas = names.iter().map(of_area).collect::<Result<_, _>>()?;
        let of_stage = |stage: &crate::page::StageState| {
            Subscriber::open(&node, &topic::health(stage.stage, stage.area.map(|area| names[area])))
        };
        let health = page.stages.iter().map(of_stage).collect::<Result<_, _>>()?;
        let recorded = configuration.as_recorded;
        Ok((Self { launch: launch.clone(), recorded, areas, health, _node: node }, page))
    }

    /// Takes in everything that has come.
    ///
    /// # Errors
    /// The transport refuses.
    pub fn drain(&self, page: &mut Page) -> Result<(), TransportError> {
        for (area, (solutions, parameters)) in self.areas.iter().enumerate() {
            while let Some(solution) = solutions.take()? {
                page.solution(area, &solution);
            }
            while let Some(set) = parameters.take()? {
                page.parameters(area, &set);
            }
        }
        for (stage, port) in self.health.iter().enumerate() {
            while let Some(health) = port.take()? {
                page.health(stage, &health, monotonic_ns());
            }
        }
        Ok(())
    }

    /// The configuration of the launch; `None` where it is a recorded run.
    pub fn configuration(&self) -> Option<&Path> {
        (!self.recorded).then_some(self.launch.configuration.as_path())
    }

    /// Whether the launch still runs.
    pub fn is_alive(&self) -> bool {
        self.launch.is_alive()
    }
}
