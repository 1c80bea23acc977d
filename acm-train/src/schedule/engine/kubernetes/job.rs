//! The manifest of an Indexed Job (`batch/v1`).

use serde_json::Value;

/// Exit codes that another attempt does not change: usage or configuration, and data.
const HOPELESS: [u8; 2] = [2, 3];

/// Contents of the manifest.
#[derive(Debug, Clone)]
pub struct Job {
    /// Name of the Job: letters, digits and hyphens.
    pub name: String,
    /// Number of pods, one for each run.
    pub runs: usize,
    /// Number of pods at the same time.
    pub parallelism: usize,
    /// Largest number of attempts at a run.
    pub attempts: usize,
    /// Image of the container.
    pub image: String,
    /// Command of a pod, with its arguments.
    pub command: Vec<String>,
    /// The directory that it is called in, which the volume is mounted at.
    pub directory: String,
    /// Claim of that volume.
    pub claim: String,
    /// Number of processors of a pod.
    pub cpus: usize,
    /// Memory of a pod, in the notation of Kubernetes.
    pub memory: Option<String>,
    /// Queue of Kueue.
    pub queue: Option<String>,
}

impl Job {
    /// Writes the manifest as YAML. Text is quoted as in JSON, which YAML reads alike.
    pub fn yaml(&self) -> String {
        let Self { runs, parallelism, cpus, .. } = self;
        let text = |text: &str| Value::from(text).to_string();
        let labels = self
            .queue
            .as_ref()
            .map_or(String::new(), |queue| format!("\n  labels:\n    kueue.x-k8s.io/queue-name: {}", text(queue)));
        let suspend = if self.queue.is_some() { "\n  suspend: true" } else { "" };
        let memory = self.memory.as_ref().map_or(String::new(), |size| format!(", memory: {}", text(size)));
        let (name, image, directory, claim) =
            (text(&self.name), text(&self.image), text(&self.directory), text(&self.claim));
        let (again, hopeless, command) =
            (self.attempts.saturating_sub(1), Value::from(HOPELESS.to_vec()), Value::from(self.command.clone()));
        format!(
            "\
# Written by acm-train: {runs} runs, one for each index. kubectl apply -f takes it.
apiVersion: batch/v1
kind: Job
metadata:
  name: {name}{labels}
spec:{suspend}
  completionMode: Indexed
  completions: {runs}
  parallelism: {parallelism}
  backoffLimitPerIndex: {again}
  podFailurePolicy:
    rules:
    - action: FailIndex   # usage, configuration or data: another attempt ends alike
      onExitCodes: {{ operator: In, values: {hopeless} }}
    - action: Ignore      # the node went away: the run goes on from its checkpoint
      onPodConditions: [{{ type: DisruptionTarget, status: \"True\" }}]
  template:
    spec:
      restartPolicy: Never
      containers:
      - name: run
        image: {image}
        command: {command}
        workingDir: {directory}
        resources:
          requests: {{ cpu: {cpus}{memory} }}
          limits: {{ cpu: {cpus}{memory} }}
        volumeMounts: [{{ name: runs, mountPath: {directory} }}]
      volumes:
      - name: runs
        persistentVolumeClaim: {{ claimName: {claim} }}
"
        )
    }
}
