//! `nucleus wedge --on slurm`, against the real `munged`, `slurmctld` and `slurmd` on this machine. Skipped with a word where
//! they are not installed, or where the test may not start them.
#![cfg(unix)]

use std::fs;
use std::net::TcpListener;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use nucleus_cache::Playback;

use crate::sample::{assert_refused, folder, nucleus, scene, stderr, stdout};

/// A cluster of one node, which ends with the test.
struct Cluster {
    daemons: Vec<Child>,
    config: PathBuf,
}

impl Drop for Cluster {
    fn drop(&mut self) {
        for daemon in self.daemons.iter_mut().rev() {
            // It may have ended already.
            let _ = daemon.kill();
            let _ = daemon.wait();
        }
    }
}

impl Cluster {
    /// Starts a cluster; an error says why it cannot.
    fn start(folder: &Path) -> Result<Self, String> {
        let daemons = ["munged", "slurmctld", "slurmd"].map(installed);
        let [Some(munged), Some(slurmctld), Some(slurmd)] = daemons else {
            return Err("SLURM is not installed".to_owned());
        };
        let is_root = Command::new("id").arg("-u").output().is_ok_and(|id| id.stdout == b"0\n");
        if !is_root {
            return Err("only root starts slurmd".to_owned());
        }
        let config = write_config(folder);
        let quiet = |program: &Path| {
            let mut command = Command::new(program);
            command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
            // A process group of its own: what a daemon signals to its group does not reach the test.
            command.process_group(0);
            command
        };
        let file = |option: &str, name: &str| format!("--{option}={}", folder.join(name).display());
        let mut cluster = Self { daemons: Vec::new(), config };
        let mut start = |command: &mut Command| {
            cluster.daemons.push(command.spawn().map_err(|error| error.to_string())?);
            Ok::<(), String>(())
        };
        start(quiet(&munged).args(["--foreground", "--force"]).args([
            file("socket", "munge.sock"),
            file("key-file", "munge.key"),
            file("log-file", "munge.log"),
            file("pid-file", "munge.pid"),
            file("seed-file", "munge.seed"),
        ]))?;
        wait_for("munged does not start", || folder.join("munge.sock").exists());
        let config = folder.join("slurm.conf");
        start(quiet(&slurmctld).arg("-D").arg("-f").arg(&config))?;
        start(quiet(&slurmd).arg("-D").arg("-f").arg(&config))?;
        wait_for("the node does not come up", || cluster.call("sinfo", &["-h", "-o", "%T"]).contains("idle"));
        Ok(cluster)
    }

    /// The output of a program of SLURM.
    fn call(&self, program: &str, arguments: &[&str]) -> String {
        let mut command = Command::new(program);
        let output = command.args(arguments).env("SLURM_CONF", &self.config).output();
        output.map(|output| String::from_utf8_lossy(&output.stdout).into_owned()).unwrap_or_default()
    }

    fn nucleus(&self, folder: &Path, arguments: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_nucleus"));
        command.args(arguments).current_dir(folder).env("SLURM_CONF", &self.config);
        command.output().unwrap()
    }
}

fn installed(program: &str) -> Option<PathBuf> {
    let folders = ["/usr/sbin", "/usr/bin", "/usr/local/sbin"];
    folders.iter().map(|folder| Path::new(folder).join(program)).find(|path| path.exists())
}

fn write_config(folder: &Path) -> PathBuf {
    let at = folder.display();
    let name = fs::read_to_string("/proc/sys/kernel/hostname").unwrap();
    let name = name.trim().split('.').next().unwrap();
    for sub in ["state", "spool"] {
        fs::create_dir_all(folder.join(sub)).unwrap();
    }
    fs::write(folder.join("munge.key"), [7; 128]).unwrap();
    use std::os::unix::fs::PermissionsExt;
    fs::set_permissions(folder.join("munge.key"), PermissionsExt::from_mode(0o400)).unwrap();
    let port = || TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let [control, node] = [port(), port()];
    let text = format!(
        "ClusterName=test\nSlurmctldHost={name}(127.0.0.1)\nSlurmctldPort={control}\nSlurmdPort={node}\n\
         AuthType=auth/munge\nAuthInfo=socket={at}/munge.sock\nCredType=cred/munge\nSlurmUser=root\n\
         StateSaveLocation={at}/state\nSlurmdSpoolDir={at}/spool\nSlurmctldPidFile={at}/ctld.pid\nSlurmdPidFile={at}/d.pid\n\
         SlurmctldLogFile={at}/ctld.log\nSlurmdLogFile={at}/d.log\nProctrackType=proctrack/linuxproc\n\
         TaskPlugin=task/none\nSelectType=select/cons_tres\nSelectTypeParameters=CR_Core\nJobCompType=jobcomp/none\n\
         MpiDefault=none\nReturnToService=2\nMailProg=/bin/true\nSchedulerParameters=sched_interval=2,batch_sched_delay=0\n\
         MaxArraySize=3\nNodeName={name} NodeAddr=127.0.0.1 CPUs=2 RealMemory=1000 State=UNKNOWN\n\
         PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP\n"
    );
    let path = folder.join("slurm.conf");
    fs::write(&path, text).unwrap();
    path
}

fn wait_for(what: &str, is_there: impl Fn() -> bool) {
    let begin = Instant::now();
    while !is_there() {
        assert!(begin.elapsed() < Duration::from_secs(120), "{what}");
        sleep(Duration::from_millis(20));
    }
}

const VALUES: &str = "cloth1.bendResistance=0.1,1,10";

#[test]
fn a_wedge_on_slurm_resumes_lost_runs_and_collects_the_bytes_of_local_runs() {
    let (machine, folder) = (folder(), folder());
    let cluster = match Cluster::start(machine.path()) {
        Ok(cluster) => cluster,
        Err(why) => return println!("skipped: {why}"),
    };
    scene(folder.path(), 300, "");
    let local = ["wedge", "drape.ron", "--vary", VALUES, "--checkpoint", "10", "--out", "local"];
    let output = nucleus(folder.path(), &local);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));

    // Submitted and left alone: two arrays, because this cluster takes two tasks at most.
    let farm =
        ["wedge", "drape.ron", "--vary", VALUES, "--checkpoint", "10", "--out", "farm", "--on", "slurm"];
    let output =
        cluster.nucleus(folder.path(), &[&farm[..], &["--detach", "--task-memory", "100M"]].concat());
    assert!(stderr(&output).contains("submitted 3 runs"), "{}", stderr(&output));
    let jobs = fs::read_to_string(folder.path().join("farm/slurm/jobs.jsonl")).unwrap();
    assert_eq!(jobs.lines().count(), 2);

    // One task is lost within its run. Another one is asked to end twice, so that it has no time for a result.
    let first: serde_json::Value = serde_json::from_str(jobs.lines().next().unwrap()).unwrap();
    let frames = || {
        let part = Playback::open(folder.path().join("farm/runs/0000.mcap.part"));
        part.map_or(0, |cache| cache.time_samples().len())
    };
    let has_ended = || folder.path().join("farm/results/0000.json").exists();
    wait_for("the first task does not start", || frames() > 20 || has_ended());
    cluster.call("scancel", &["--signal=KILL", "--full", &format!("{}_0", first["job"])]);
    for _ in 0..2 {
        cluster.call("scancel", &["--signal=TERM", "--full", &format!("{}_1", first["job"])]);
    }

    // Another coordinator waits, submits the lost run again and collects.
    let wait =
        ["wedge", "--continue", "--out", "farm", "--on", "slurm", "--poll", "0.2", "--task-memory", "100M"];
    let output = cluster.nucleus(folder.path(), &wait);
    assert_eq!(output.status.code(), Some(0), "{}{}", stdout(&output), stderr(&output));
    assert!(stdout(&output).contains("3 runs: 3 success"), "{}", stdout(&output));
    for run in ["0000", "0001", "0002"] {
        let bytes = |out: &str| fs::read(folder.path().join(format!("{out}/runs/{run}.mcap"))).unwrap();
        assert!(bytes("farm") == bytes("local"), "run {run}");
    }
    // What SLURM refuses is passed on, and nothing is lost.
    let refused = [&local[..7], &["refused", "--on", "slurm", "--partition", "none"]].concat();
    let output = cluster.nucleus(folder.path(), &refused);
    assert_refused(&output, "invalid partition");
}

#[test]
fn a_farm_without_slurm_is_refused_before_anything_is_written() {
    let folder = folder();
    scene(folder.path(), 3, "");
    let mut command = Command::new(env!("CARGO_BIN_EXE_nucleus"));
    command.args(["wedge", "drape.ron", "--vary", VALUES, "--out", "w", "--on", "slurm"]).env("PATH", "");
    let output = command.current_dir(folder.path()).output().unwrap();
    assert_refused(&output, "SLURM is not installed here: there is no `sbatch`");
    assert!(!folder.path().join("w").exists());
}
