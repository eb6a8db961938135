// Images as the server sends them.

import { Code, ConnectError } from "@connectrpc/connect";
import { mayPass, type Api } from "../api";
import { ImageCollector, type Image } from "./image";

const WAITS_MS = [500, 1000, 2000, 4000, 8000]; // a server that is started again takes less
const LONGEST_SILENCE_MS = 30_000;

/** Returns all images of a scene. A few times begins again when the connection is lost; throws the last time. */
export async function readImages(api: Api, scene: string, waits = WAITS_MS): Promise<Image[]> {
  for (let n = 0; ; ++n) {
    try {
      return await readOnce(api, scene);
    } catch (error) {
      if (n === waits.length || !mayPass(error)) throw error;
    }
    await new Promise((resolve) => setTimeout(resolve, waits[n]));
  }
}

async function readOnce(api: Api, scene: string): Promise<Image[]> {
  const collector = new ImageCollector();
  const givenUp = new AbortController();
  const limit = () => setTimeout(() => givenUp.abort(), LONGEST_SILENCE_MS);
  let silence = limit();
  try {
    for await (const message of api.scenes.readImages({ name: scene }, { signal: givenUp.signal })) {
      clearTimeout(silence);
      silence = limit();
      collector.take(message);
    }
  } finally {
    clearTimeout(silence);
  }
  if (!collector.isWhole) throw new ConnectError("the images broke off", Code.Unavailable);
  return collector.images;
}
