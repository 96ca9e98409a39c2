// Validates glTF files with Khronos' validator: gltf_validates.js NODE_MODULES FILE... Fails on any error, warning, information or hint.
const fs = require("fs");
const validator = require(process.argv[2] + "/gltf-validator");

async function main() {
  for (const path of process.argv.slice(3)) {
    const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(path)));
    const { numErrors, numWarnings, numInfos, numHints, messages } = report.issues;
    console.log(
      `glTF validator ${validator.version()}, ${path}: ${numErrors} errors, ${numWarnings} warnings, ${numInfos} infos, ` +
        `${numHints} hints; ${report.info.animationCount} animation, ${report.info.totalVertexCount} vertices, ` +
        `${report.info.totalTriangleCount} triangles`,
    );
    for (const message of messages) console.log(message);
    if (numErrors + numWarnings + numInfos + numHints > 0) process.exitCode = 1;
  }
}

main();
