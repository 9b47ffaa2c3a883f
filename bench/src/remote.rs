//! The harness's end of a worker.

use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use anyhow::{Result, bail};
use clap::ValueEnum;

use crate::machine;
use crate::protocol::{Kind, MARK, Reply, Request};

/// How many times as long as its limit a worker may take if other programs keep it from running.
const PATIENCE: u32 = 20;

/// How long a worker may take to make its boxes.
const START_LIMIT: Duration = Duration::from_secs(120);

/// A worker that runs; dropped, it is stopped.
pub struct Remote {
    child: Child,
    requests: ChildStdin,
    replies: Receiver<String>,
}

/// What came of a request.
pub enum Outcome {
    /// The worker answered.
    Reply(Reply),
    /// It exceeded its limit and was stopped.
    Late,
    /// It ended by itself; how, in words.
    Ended(String),
}

impl Remote {
    /// Starts a worker and waits until it has its boxes.
    pub fn start(
        kind: Kind,
        library: &str,
        scene: &str,
        dimensions: usize,
        boxes: usize,
        seeds: Option<usize>,
    ) -> Result<Self> {
        let mut child = Command::new(std::env::current_exe()?)
            .args(["worker", "--library", library, "--scene", scene])
            .args(["--dimensions", &dimensions.to_string(), "--boxes", &boxes.to_string()])
            .args(seeds.map(|seeds| format!("--seeds={seeds}")))
            .args(kind.to_possible_value().map(|kind| format!("--kind={}", kind.get_name())))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::inherit())
            .spawn()?;
        let (Some(requests), Some(output)) = (child.stdin.take(), child.stdout.take()) else {
            bail!("a worker without pipes");
        };
        let (sender, replies) = channel();
        std::thread::spawn(move || {
            for line in BufReader::new(output).lines().map_while(Result::ok) {
                if let Some(reply) = line.strip_prefix(MARK)
                    && sender.send(reply.to_owned()).is_err()
                {
                    return;
                }
            }
        });
        let mut remote = Self { child, requests, replies };
        match remote.receive(START_LIMIT)? {
            Outcome::Reply(_) => Ok(remote),
            Outcome::Late => bail!("the worker of {library} does not start"),
            Outcome::Ended(how) => bail!("the worker of {library} did not start: {how}"),
        }
    }

    /// Sends a request and waits for the reply for as long as `limit`.
    pub fn ask(&mut self, request: &Request, limit: Duration) -> Result<Outcome> {
        if writeln!(self.requests, "{}", serde_json::to_string(request)?).is_err() {
            return Ok(Outcome::Ended(self.epitaph()));
        }
        self.receive(limit)
    }

    /// Waits for a reply until the worker has run for as long as `limit`: the time for which other
    /// programs kept it from running does not count, up to [`PATIENCE`] times the limit.
    fn receive(&mut self, limit: Duration) -> Result<Outcome> {
        let worker = self.child.id();
        let (waited, start) = (machine::waited(worker), Instant::now());
        let mut left = limit;
        loop {
            match self.replies.recv_timeout(left) {
                Ok(reply) => return Ok(Outcome::Reply(serde_json::from_str(&reply)?)),
                Err(RecvTimeoutError::Disconnected) => return Ok(Outcome::Ended(self.epitaph())),
                Err(RecvTimeoutError::Timeout) => {}
            }
            let elapsed = start.elapsed();
            let ran = elapsed.saturating_sub(machine::waited(worker).saturating_sub(waited));
            if ran >= limit || elapsed > PATIENCE * limit {
                let _ = self.child.kill();
                return Ok(Outcome::Late);
            }
            left = limit - ran;
        }
    }

    /// How the worker ended.
    fn epitaph(&mut self) -> String {
        self.child.wait().map_or_else(|error| error.to_string(), |status| status.to_string())
    }
}

impl Drop for Remote {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
