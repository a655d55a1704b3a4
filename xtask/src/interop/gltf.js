// The reference validator of Khronos looks at the glTF file.

const fs = require("fs");
const validator = require("gltf-validator");

const [, folder] = process.argv.slice(2);
validator.validateBytes(new Uint8Array(fs.readFileSync(`${folder}/run.glb`))).then(({ validatorVersion, issues }) => {
  const told = issues.messages.filter(({ severity }) => severity < 2).map(({ code, pointer }) => `${code} at ${pointer}`);
  const trouble = told.length > 0 ? told.slice(0, 5).join(", ") : null;
  console.log(JSON.stringify([{ what: "glb: valid", reader: `glTF validator ${validatorVersion}`, error: null, trouble }]));
});
