// SPDX-License-Identifier: MIT
/** The WebSocket to hapticd-view. It carries requests and their answers, and messages that the server sends by itself.
 * It connects again when the connection was lost. */

const kHeadWords = 4; // number of words at the head of a binary message
const kMeshMessage = 0x80000000, kVerticesMessage = 0x100;
const kAgainMs = 1000, kAskWhyAfter = 3;

export class Connection extends EventTarget {
  #socket = null;
  #next = 1;
  #pending = new Map();
  #failed = 0; // failed attempts to connect in a row
  #mesh = null; // the newest mesh: it comes directly before the answer that names it

  constructor(url) {
    super();
    this.url = url;
    this.#open();
  }

  get open() { return this.#socket?.readyState === WebSocket.OPEN; }

  /** Sends a request. The promise resolves to its answer {ok, error, ...}, and is never rejected. */
  ask(request) {
    if (!this.open) return Promise.resolve({ok: false, error: 'not connected'});
    const id = this.#next++;
    this.#socket.send(JSON.stringify({...request, id}));
    return new Promise((resolve) => this.#pending.set(id, resolve));
  }

  /** Sends bytes that need no answer. */
  put(bytes) {
    if (this.open && this.#socket.bufferedAmount < 4096) this.#socket.send(bytes);
  }

  #open() {
    const socket = new WebSocket(this.url, ['hapticd.1']);
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => { this.#failed = 0; };
    socket.onmessage = ({data}) => (typeof data === 'string' ? this.#text(JSON.parse(data)) : this.#bytes(data));
    socket.onclose = () => {
      for (const resolve of this.#pending.values()) resolve({ok: false, error: 'the connection was lost'});
      this.#pending.clear();
      this.#tell('lost');
      if (++this.#failed === kAskWhyAfter) this.#askWhy();
      setTimeout(() => this.#open(), kAgainMs);
    };
    this.#socket = socket;
  }

  /** Asks the server why it refuses the WebSocket: a browser does not tell this, but a plain request does. */
  async #askWhy() {
    const answer = await fetch('./', {method: 'HEAD', cache: 'no-store'}).catch(() => null);
    if (answer?.status === 401) this.#tell('refused', 'hapticd-view was started again: open the address that it printed');
    else if (answer?.ok) this.#tell('refused', 'hapticd-view serves at most 8 pages at a time: close one of them');
    else this.#tell('refused', 'The run and its view have ended. To begin again: hapticd run SCENE --view');
  }

  #text(message) {
    if (message.type !== 'answer') return this.#tell(message.type, message);
    const resolve = this.#pending.get(message.id);
    this.#pending.delete(message.id);
    const mesh = this.#mesh;
    this.#mesh = null;
    return resolve?.({...message, mesh});
  }

  #bytes(buffer) {
    const head = new Uint32Array(buffer, 0, kHeadWords);
    if (head[0] === kMeshMessage) this.#mesh = parseMesh(buffer, head);
    else if (head[0] >= kVerticesMessage)
      this.#tell('vertices', {model: head[0] - kVerticesMessage, xyz: new Float32Array(buffer, 16, 3 * head[2])});
    else this.#tell('rows', {stream: head[0], rowBytes: head[1], count: head[2], bytes: new DataView(buffer, 16)});
  }

  #tell(type, detail) { this.dispatchEvent(new CustomEvent(type, {detail})); }
}

function parseMesh(buffer, head) {
  const [, vertices, triangles, flags] = head;
  let at = 16;
  const take = (Type, count) => {
    const part = new Type(buffer, at, count);
    at += 4 * count;
    return part;
  };
  const xyz = take(Float32Array, 3 * vertices);
  const normals = (flags & 1) !== 0 ? take(Float32Array, 3 * vertices) : null;
  const corners = take(Uint32Array, 3 * triangles);
  return {xyz, normals, corners, colours: (flags & 2) !== 0 ? take(Uint32Array, vertices) : null};
}
