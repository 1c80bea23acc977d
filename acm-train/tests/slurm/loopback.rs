//! A whole Slurm in a temporary folder: controller and one node, on free ports of the loopback, as the current user. It ends
//! with the value that stands for it, and everything that it started does too.

use std::{
    ffi::OsStr,
    fs::{self, File},
    net::TcpListener,
    num::NonZeroUsize,
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    thread::{available_parallelism, sleep},
    time::Duration,
};

use tempfile::TempDir;

const MOMENT: Duration = Duration::from_millis(100);
/// Moments after which something that does not come is taken to hang.
const LONG: usize = 2400;
const PROGRAMS: [&str; 5] = ["slurmctld", "slurmd", "sbatch", "squeue", "scontrol"];

/// Controller and node.
pub struct Loopback {
    folder: TempDir,
    node_name: String,
    controller: Child,
    node: Child,
}

impl Loopback {
    /// Starts it; `None`, with a line that says so, where Slurm is not installed.
    pub fn start() -> Option<Self> {
        if let Some(missing) = PROGRAMS.iter().find(|program| installed(program).is_none()) {
            eprintln!("skipped: there is no {missing} here; scripts/install-test-tools installs Slurm");
            return None;
        }
        let folder = tempfile::tempdir().unwrap();
        let host = fs::read_to_string("/proc/sys/kernel/hostname").unwrap();
        let node_name = host.trim().split('.').next().unwrap().to_string();
        for inside in ["state", "spool", "log"] {
            fs::create_dir(folder.path().join(inside)).unwrap();
        }
        fs::write(folder.path().join("slurm.conf"), configuration(folder.path(), &node_name)).unwrap();
        let controller = daemon(folder.path(), "slurmctld");
        let node = daemon(folder.path(), "slurmd");
        let slurm = Self { folder, node_name, controller, node };
        slurm.until("the node is idle", || slurm.said("sinfo", &["--noheader", "--format=%T"]).trim() == "idle");
        Some(slurm)
    }

    /// A command that talks to this Slurm.
    pub fn command(&self, program: impl AsRef<OsStr>) -> Command {
        let mut command = Command::new(program);
        command.env("SLURM_CONF", self.folder.path().join("slurm.conf"));
        command
    }

    /// What one of Slurm's programs prints; nothing where it fails.
    pub fn said(&self, program: &str, arguments: &[&str]) -> String {
        let output = self.command(installed(program).unwrap()).args(arguments).output().unwrap();
        String::from_utf8_lossy(&output.stdout).into_owned()
    }

    /// Kills the controller without warning, and starts it again after a while; and the node's daemon after it.
    pub fn controller_dies_and_comes_back(&mut self) {
        self.controller.kill().unwrap();
        self.controller.wait().unwrap();
        sleep(10 * MOMENT);
        self.controller = daemon(self.folder.path(), "slurmctld");
        self.until("the controller is back", || self.said("scontrol", &["ping"]).contains("UP"));
        // What the controller has forgotten, or takes to be at work still, it learns when the node comes anew, within a
        // second instead of minutes.
        self.node.kill().unwrap();
        self.node.wait().unwrap();
        self.node = daemon(self.folder.path(), "slurmd");
    }

    /// What an administrator does: a controller that comes back may find jobs on the node that it has forgotten, and drains it.
    fn resume(&self) {
        if self.said("sinfo", &["--noheader", "--format=%T"]).trim().starts_with("drain") {
            self.said("scontrol", &["update", &format!("nodename={}", self.node_name), "state=resume"]);
        }
    }

    /// Waits for something that must come.
    #[track_caller]
    pub fn until(&self, what: &str, mut there: impl FnMut() -> bool) {
        for moment in 0..LONG {
            if there() {
                return;
            }
            if moment % 10 == 9 {
                self.resume();
            }
            // A task that ended as the controller died is at work for ever, until the node says what it has.
            if moment % 50 == 49 {
                self.said("scontrol", &["reconfigure"]);
            }
            sleep(MOMENT);
        }
        let log = |name: &str| fs::read_to_string(self.folder.path().join("log").join(name)).unwrap_or_default();
        panic!(
            "this does not come: {what}\n{}\n{}\n{}",
            self.said("squeue", &[]),
            log("slurmctld.log"),
            log("slurmd.log")
        );
    }
}

impl Drop for Loopback {
    fn drop(&mut self) {
        for daemon in [&mut self.controller, &mut self.node] {
            let _ = daemon.kill();
            let _ = daemon.wait();
        }
        // Tasks outlive the daemons. They are known by the configuration that they were started with.
        let mark = format!("SLURM_CONF={}", self.folder.path().join("slurm.conf").display());
        for process in fs::read_dir("/proc").into_iter().flatten().flatten().map(|entry| entry.path()) {
            let started_here = fs::read(process.join("environ"))
                .is_ok_and(|environment| environment.split(|&byte| byte == 0).any(|one| one == mark.as_bytes()));
            if let (true, Some(pid)) = (started_here, process.file_name().and_then(|name| name.to_str())) {
                kill(pid);
            }
        }
    }
}

/// Ends a process at once.
pub fn kill(pid: &str) {
    let _ = Command::new("kill").args(["-9", pid]).stderr(Stdio::null()).status();
}

fn daemon(folder: &Path, name: &str) -> Child {
    let log = File::options().create(true).append(true).open(folder.join("log").join(format!("{name}.log"))).unwrap();
    let mut command = Command::new(installed(name).unwrap());
    command.arg("-D").env("SLURM_CONF", folder.join("slurm.conf"));
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(log).spawn().unwrap()
}

/// Daemons lie where the path of an ordinary user does not lead.
fn installed(program: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let folders = std::env::split_paths(&path).chain(["/usr/sbin".into(), "/usr/local/sbin".into()]);
    folders.map(|folder| folder.join(program)).find(|file| file.is_file())
}

fn free_port() -> u16 {
    TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port()
}

/// Arrays are small, so that a list of runs becomes several; and nothing waits for a scheduler that runs once a minute.
fn configuration(folder: &Path, node: &str) -> String {
    let (folder, cores) = (folder.display(), available_parallelism().map_or(1, NonZeroUsize::get));
    let user = String::from_utf8(Command::new("id").arg("-un").output().unwrap().stdout).unwrap();
    let (user, controller, daemon) = (user.trim(), free_port(), free_port());
    format!(
        "ClusterName=acmtest
SlurmctldHost={node}(127.0.0.1)
SlurmctldPort={controller}
SlurmdPort={daemon}
AuthType=auth/none
CredType=cred/none
SlurmUser={user}
SlurmdUser={user}
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
ProctrackType=proctrack/pgid
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=batch_sched_delay=0,sched_interval=1
ReturnToService=2
KillWait=1
BatchStartTimeout=1
MaxArraySize=10
NodeName={node} NodeAddr=127.0.0.1 CPUs={cores} RealMemory=1000 State=UNKNOWN
PartitionName=lab Nodes={node} Default=YES MaxTime=INFINITE State=UP
"
    )
}
