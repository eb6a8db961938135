// node validate.mjs FILE: exit status 1 if the Khronos glTF validator has an error or a warning about it.
import { readFile } from "node:fs/promises";
import { validateBytes } from "gltf-validator";

const severities = ["error", "warning"];
const report = await validateBytes(new Uint8Array(await readFile(process.argv[2])), { maxIssues: 100 });
for (const message of report.issues.messages) {
  console.log(`${severities[message.severity] ?? "note"}: ${message.pointer ?? message.offset}: ${message.code}: ${message.message}`);
}
const { numErrors, numWarnings } = report.issues;
console.log(`${numErrors} errors, ${numWarnings} warnings, ${report.info.totalVertexCount} vertices`);
process.exitCode = numErrors + numWarnings > 0 ? 1 : 0;
