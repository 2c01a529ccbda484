// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Reads an exported MCAP by Foxglove's reader and checks each message against Foxglove's schemas. Needs the packages
// that tests/nightly.sh installs.
//   node foxglove_messages.mjs FILE.mcap
import {open} from "node:fs/promises";
import {foxgloveMessageSchemas, generateJsonSchema} from "@foxglove/schemas/internal.js";
import {McapIndexedReader} from "@mcap/core";
import {FileHandleReadable} from "@mcap/nodejs";
import {loadDecompressHandlers} from "@mcap/support";
import Ajv from "ajv";

const ajv = new Ajv({strict: false, validateFormats: false});
const checks = new Map(
  Object.values(foxgloveMessageSchemas).map((schema) => [
    `foxglove.${schema.name}`,
    ajv.compile(generateJsonSchema(schema)),
  ]),
);
const reader = await McapIndexedReader.Initialize({
  readable: new FileHandleReadable(await open(process.argv[2])),
  decompressHandlers: await loadDecompressHandlers(),
});
const counts = {};
for await (const message of reader.readMessages()) {
  const channel = reader.channelsById.get(message.channelId);
  const schema = reader.schemasById.get(channel.schemaId).name;
  const check = checks.get(schema);
  if (!check) throw new Error(`${channel.topic}: Foxglove has no ${schema}`);
  if (!check(JSON.parse(new TextDecoder().decode(message.data))))
    throw new Error(`${channel.topic}: ${JSON.stringify(check.errors[0])}`);
  counts[channel.topic] = (counts[channel.topic] ?? 0) + 1;
}
const topics = ["/camera/image", "/camera/calibration", "/tf", "/path", "/camera/tracks", "/scene"];
for (const topic of topics) if (!counts[topic]) throw new Error(`no message in ${topic}`);
console.log(counts);
