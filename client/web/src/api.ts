// Calls to the server that this page came from.

import { Code, ConnectError, createClient, type Interceptor } from "@connectrpc/connect";
import { createGrpcWebTransport } from "@connectrpc/connect-web";
import { findTrailerError } from "@connectrpc/connect/protocol-grpc";
import { create, fromBinary, toBinary, type DescMessage, type MessageInitShape, type MessageShape } from "@bufbuild/protobuf";
import {
  CreateSceneRequestSchema,
  ImportSceneRequestSchema,
  SceneSchema,
  SceneService,
  type CreateSceneRequest,
  type ImportOptionsSchema,
  type Scene,
} from "./gen/alvor/v1/scene_service_pb";
import { SolveService } from "./gen/alvor/v1/solve_service_pb";

/** `token` is asked anew for each call; empty for none. `onBytes` is told of what arrives. */
export function connect(origin: string, token: () => string, onBytes: (count: number) => void = () => undefined) {
  const authorize: Interceptor = (next) => (request) => {
    if (token()) request.header.set("Authorization", `Bearer ${token()}`);
    return next(request);
  };
  const transport = createGrpcWebTransport({ baseUrl: origin, useBinaryFormat: true, interceptors: [authorize], fetch: counted(onBytes) });
  return {
    scenes: createClient(SceneService, transport),
    solves: createClient(SolveService, transport),
    createScene: (messages: CreateSceneRequest[]) =>
      send(origin, token(), "CreateScene", messages.map((message) => framed(CreateSceneRequestSchema, message))),
    importScene: async (options: MessageInitShape<typeof ImportOptionsSchema>, requestId: string, files: NamedFile[]) =>
      send(origin, token(), "ImportScene", [framed(ImportSceneRequestSchema, beginning(options, requestId)), ...(await piecesOf(files))]),
  };
}

/** A file, by the name that the scene uses for it. */
export interface NamedFile {
  name: string;
  content: Blob;
}

const PIECE_BYTES = 4 << 20;

function beginning(options: MessageInitShape<typeof ImportOptionsSchema>, requestId: string) {
  return create(ImportSceneRequestSchema, { content: { case: "options", value: options }, requestId });
}

async function piecesOf(files: NamedFile[]): Promise<Blob[]> {
  const pieces: Blob[] = [];
  for (const { name, content } of files)
    for (let offset = 0; offset === 0 || offset < content.size; offset += PIECE_BYTES) {
      const bytes = new Uint8Array(await content.slice(offset, offset + PIECE_BYTES).arrayBuffer());
      const value = { file: name, offset: BigInt(offset), content: bytes };
      pieces.push(framed(ImportSceneRequestSchema, create(ImportSceneRequestSchema, { content: { case: "piece", value } })));
    }
  return pieces;
}

/** `scenes/{scene}` of `scenes/{scene}/solves/{solve}`. */
export const sceneOf = (solve: string) => solve.slice(0, solve.indexOf("/solves/"));

export type Api = ReturnType<typeof connect>;

function counted(onBytes: (count: number) => void): typeof fetch {
  return async (input, init) => {
    const response = await fetch(input, init);
    const count = new TransformStream<Uint8Array, Uint8Array>({
      transform(chunk, controller) {
        onBytes(chunk.length);
        controller.enqueue(chunk);
      },
    });
    return new Response(response.body?.pipeThrough(count as never), response);
  };
}

// Browsers cannot stream upwards, but a request may well hold several messages.
async function send(origin: string, token: string, call: string, messages: Blob[]): Promise<Scene> {
  const body = new Blob(messages);
  const headers: Record<string, string> = { "Content-Type": "application/grpc-web+proto", "X-Grpc-Web": "1" };
  if (token) headers.Authorization = `Bearer ${token}`;
  let response: Response;
  try {
    response = await fetch(`${origin}/${SceneService.typeName}/${call}`, { method: "POST", headers, body });
  } catch {
    throw new ConnectError("the server cannot be reached", Code.Unavailable);
  }
  if (!response.ok) throw new ConnectError(`the server answered ${response.status}`, Code.Unavailable);
  const frames = unframed(new Uint8Array(await response.arrayBuffer()));
  const trailers = new Headers();
  for (const { flags, bytes } of frames)
    if (flags & 0x80)
      for (const line of new TextDecoder().decode(bytes).trim().split("\r\n")) {
        const colon = line.indexOf(":");
        trailers.set(line.slice(0, colon), line.slice(colon + 1).trim());
      }
  const refusal = findTrailerError(trailers);
  if (refusal) throw refusal;
  const message = frames.find(({ flags }) => flags === 0);
  if (!message) throw new ConnectError("the server did not answer", Code.Internal);
  return fromBinary(SceneSchema, message.bytes);
}

function framed<Schema extends DescMessage>(schema: Schema, message: MessageShape<Schema>): Blob {
  const bytes = toBinary(schema, message) as Uint8Array<ArrayBuffer>;
  const header = new Uint8Array(5);
  new DataView(header.buffer).setUint32(1, bytes.length);
  return new Blob([header, bytes]);
}

function unframed(body: Uint8Array): { flags: number; bytes: Uint8Array }[] {
  const frames: { flags: number; bytes: Uint8Array }[] = [];
  const view = new DataView(body.buffer, body.byteOffset, body.byteLength);
  for (let at = 0; at + 5 <= body.length; ) {
    const length = view.getUint32(at + 1);
    frames.push({ flags: body[at], bytes: body.subarray(at + 5, at + 5 + length) });
    at += 5 + length;
  }
  return frames;
}

/** What to tell a person: without the name of the code, as the server says it. */
export function reasonOf(error: unknown): string {
  if (error instanceof ConnectError) return error.rawMessage || Code[error.code];
  return error instanceof Error ? error.message : String(error);
}

const PASSING = [Code.Unavailable, Code.Unknown, Code.Aborted, Code.Internal, Code.DeadlineExceeded, Code.Canceled];

/** Whether a call that failed may succeed when it is made again. */
export function mayPass(error: unknown): boolean {
  return PASSING.includes(ConnectError.from(error).code);
}
