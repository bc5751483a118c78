//! The child processes: one a stage, restarted with a growing pause when they die.

use crate::{LaunchError, Options};
use messages::Stage;
use pipeline::configuration::Configuration;
use runtime::{Context, POISONED_EXIT_CODE, monotonic_ns};
use std::os::unix::process::CommandExt;
use std::process::{Child, Command, ExitStatus, Stdio};

/// A stage of one area, or of all (`None`).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Role {
    pub stage: Stage,
    pub area: Option<usize>,
}

/// The recorder.
pub const RECORD: Role = Role { stage: Stage::Record, area: None };

/// How the set is doing.
pub enum Outcome {
    Running,
    /// The source has published its end marks and gone.
    SourceEnded,
}

/// The first restart comes at once, each further one after twice the pause.
const PAUSE_NS: i64 = 100_000_000;
const LONGEST_PAUSE_NS: i64 = 5_000_000_000;
/// After so long without a death the pause starts small again.
const SOUND_NS: i64 = 20_000_000_000;
/// Exit code of a stage whose configuration or recording cannot be used.
pub const REFUSED_EXIT_CODE: i32 = 2;

/// The processes of one launch.
pub struct Set {
    members: Vec<Member>,
    command: Spawner,
    source: Role,
}

struct Member {
    role: Role,
    name: String,
    child: Option<Child>,
    /// Exited by itself, with success.
    done: bool,
    restarts: u64,
    pause_ns: i64,
    started_ns: i64,
    due_ns: i64,
}

/// What is needed to start a stage.
struct Spawner {
    options: Options,
    context: Context,
    areas: Vec<String>,
}

impl Set {
    /// A set of which nothing has been started; `restarts` carries the counts over from an earlier domain.
    pub fn new(configuration: &Configuration, options: &Options, context: Context, restarts: Vec<(Role, u64)>) -> Self {
        let stage = configuration.main.source.stage();
        let areas = configuration.areas.iter().map(|area| area.name.clone()).collect();
        let mut set = Self {
            members: Vec::new(),
            command: Spawner { options: options.clone(), context, areas },
            source: Role { stage, area: None },
        };
        let mut roles = Vec::new();
        if !configuration.outputs.is_empty() {
            roles.push(Role { stage: Stage::Output, area: None });
        }
        // the readers of all first
        roles.extend(configuration.record.iter().map(|_| RECORD));
        for area in 0..configuration.areas.len() {
            // readers before writers
            roles.extend(
                [Stage::Identify, Stage::Estimate, Stage::Synchronise].map(|stage| Role { stage, area: Some(area) }),
            );
        }
        roles.push(set.source);
        set.members = roles
            .into_iter()
            .map(|role| Member {
                role,
                name: set.command.name(role),
                child: None,
                done: false,
                restarts: restarts.iter().find(|(known, _)| *known == role).map_or(0, |(_, n)| *n),
                pause_ns: 0,
                started_ns: 0,
                due_ns: i64::MAX,
            })
            .collect();
        set
    }

    /// The stages that have to be ready before the source may start, with their names.
    pub fn workers(&self) -> impl Iterator<Item = (Role, &str)> {
        let workers = self.members.iter().filter(|member| member.role != self.source);
        workers.map(|member| (member.role, member.name.as_str()))
    }

    /// Starts all but the source.
    pub fn start_workers(&mut self) -> Result<(), LaunchError> {
        let Self { members, command, source } = self;
        members.iter_mut().filter(|member| member.role != *source).try_for_each(|member| member.start(command))
    }

    /// Starts the source, whose first sample is due at `epoch_ns`.
    ///
    /// With `resume` the run is under way already, in an earlier domain.
    pub fn start_source(&mut self, epoch_ns: i64, resume: bool) -> Result<(), LaunchError> {
        let Self { members, command, source } = self;
        (command.context.epoch_ns, command.context.resume) = (epoch_ns, resume);
        members.iter_mut().filter(|member| member.role == *source).try_for_each(|member| member.start(command))
    }

    /// Whether the source has been started.
    pub fn has_source(&self) -> bool {
        self.members.iter().any(|member| member.role == self.source && member.started_ns > 0)
    }

    /// Tells the source to end its streams.
    pub fn stop_source(&mut self) {
        self.ask_to_leave(self.source);
    }

    fn ask_to_leave(&mut self, role: Role) {
        let members = self.members.iter_mut().filter(|member| member.role == role);
        for child in members.filter_map(|member| member.child.as_mut()) {
            if matches!(child.try_wait(), Ok(None)) {
                // SAFETY: the process has not been waited for, so the number is still its own.
                unsafe { libc::kill(child.id() as libc::pid_t, libc::SIGTERM) };
            }
        }
    }

    /// Notices who has died and starts them again when their pause is over.
    pub fn watch(&mut self, now_ns: i64) -> Result<Outcome, LaunchError> {
        let Self { members, command, source } = self;
        for member in members.iter_mut() {
            if let Some(status) = member.exited() {
                member.child = None;
                if !status.success() {
                    tracing::warn!(process = member.name, %status, "a stage has died");
                }
                match status.code() {
                    Some(0) => member.done = true,
                    Some(code) if code == i32::from(POISONED_EXIT_CODE) => {
                        return Err(LaunchError::StagePoisoned(member.name.clone()));
                    }
                    Some(REFUSED_EXIT_CODE) => return Err(LaunchError::Refused(member.name.clone())),
                    _ => member.plan_restart(now_ns),
                }
            }
            if member.child.is_none() && now_ns >= member.due_ns {
                member.restarts += 1;
                member.start(command)?;
                let pid = member.child.as_ref().map(Child::id);
                tracing::warn!(process = member.name, pid, restarts = member.restarts, "a stage is started again");
            }
        }
        let ended = members.iter().any(|member| member.role == *source && member.done);
        Ok(if ended { Outcome::SourceEnded } else { Outcome::Running })
    }

    /// How often each stage has been restarted.
    pub fn restarts(&self) -> Vec<(Role, u64)> {
        self.members.iter().map(|member| (member.role, member.restarts)).collect()
    }

    /// The process numbers, for tests and for the curious.
    pub fn processes(&self) -> impl Iterator<Item = (&str, u32)> {
        self.members.iter().filter_map(|member| Some((member.name.as_str(), member.child.as_ref()?.id())))
    }

    /// Waits briefly for those who are about to leave, and ends the others.
    pub fn kill(&mut self) {
        // a recording should not look as if there had been a crash
        self.ask_to_leave(RECORD);
        let until_ns = monotonic_ns() + 1_000_000_000;
        for child in self.members.iter_mut().filter_map(|member| member.child.as_mut()) {
            while monotonic_ns() < until_ns && matches!(child.try_wait(), Ok(None)) {
                std::thread::sleep(std::time::Duration::from_millis(5));
            }
            // both fail only where the process is gone already
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

impl Drop for Set {
    fn drop(&mut self) {
        self.kill();
    }
}

impl Member {
    fn start(&mut self, command: &Spawner) -> Result<(), LaunchError> {
        let child = command
            .spawn(self.role, self.restarts > 0)
            .map_err(|source| LaunchError::Start { stage: self.name.clone(), source })?;
        tracing::debug!(process = self.name, pid = child.id(), "a stage starts");
        self.child = Some(child);
        self.started_ns = monotonic_ns();
        self.due_ns = i64::MAX;
        Ok(())
    }

    fn exited(&mut self) -> Option<ExitStatus> {
        self.child.as_mut()?.try_wait().ok().flatten()
    }

    fn plan_restart(&mut self, now_ns: i64) {
        if now_ns - self.started_ns > SOUND_NS {
            self.pause_ns = 0;
        }
        self.due_ns = now_ns + self.pause_ns;
        self.pause_ns = (2 * self.pause_ns).clamp(PAUSE_NS, LONGEST_PAUSE_NS);
    }
}

impl Spawner {
    fn name(&self, role: Role) -> String {
        match role.area {
            Some(area) => format!("{} of area {}", role.stage.name(), self.areas[area]),
            None => role.stage.name().to_owned(),
        }
    }

    fn spawn(&self, role: Role, restarted: bool) -> std::io::Result<Child> {
        let mut command = Command::new(&self.options.program);
        command.arg(role.stage.name()).arg(&self.options.configuration);
        command.arg("--domain").arg(&self.context.domain);
        command.args(["--run-id", &self.context.run_id.to_string()]);
        command.args(["--epoch-ns", &self.context.epoch_ns.to_string()]);
        if restarted || self.context.resume {
            command.arg("--resume");
        }
        if let Some(area) = role.area {
            command.args(["--area", &self.areas[area]]);
        }
        if let Some(folder) = self.options.record.iter().find(|_| role == RECORD) {
            command.arg("--folder").arg(folder);
        }
        if let Some(level) = self.options.log {
            command.args(["--log", level.name()]);
        }
        if let Some(duration_s) = self.options.duration_s {
            command.arg("--duration").arg(format!("{}ns", (duration_s * 1e9).round()));
        }
        // a group of its own: an interrupt from the keyboard reaches the launcher only, which ends the streams in order
        command.process_group(0).stdin(Stdio::null()).stdout(Stdio::null()).spawn()
    }
}
