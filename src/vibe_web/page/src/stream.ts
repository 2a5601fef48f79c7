// The connection to the server: messages by kind, commands, and a new try when it is lost.

import { Kind } from './messages';

const kRetry = 1000; // [ms]
const kAsk = 2000; // time of the server [ms]

export class Stream {
  private socket: WebSocket | null = null;
  private handlers = new Map<Kind, (bytes: ArrayBuffer) => void>();
  received = 0; // [bytes]
  private ahead = 0; // the clock of the server is [ms]
  private quickest = Infinity; // answer to when the server has which time [ms]

  constructor(private token: string, private rate: number, private onState: (open: boolean, text: string) => void) {
    this.connect();
    this.on(Kind.Pong, (bytes) => this.compareClocks(new Float64Array(bytes, 8, 2)));
    setInterval(() => this.askTime(), kAsk);
  }

  /** Time of the server [ms]. */
  get now() {
    return Date.now() + this.ahead;
  }

  private askTime() {
    const bytes = new ArrayBuffer(16), view = new DataView(bytes);
    view.setUint8(0, 6);
    view.setFloat64(8, performance.now(), true);
    this.send(bytes);
  }

  private compareClocks([asked, time]: Float64Array) {
    const took = performance.now() - asked;
    if (took > this.quickest) return;
    this.quickest = took;
    this.ahead = 1000 * time + took / 2 - Date.now();
  }

  on(kind: Kind, handler: (bytes: ArrayBuffer) => void) {
    this.handlers.set(kind, handler);
  }

  send(bytes: ArrayBuffer | Uint8Array) {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(bytes);
  }

  private connect() {
    const address = new URL('stream', location.href);
    address.protocol = location.protocol === 'https:' ? 'wss:' : 'ws:';
    address.hash = '';
    address.search = this.token ? '?token=' + encodeURIComponent(this.token) : '';
    const socket = new WebSocket(address);
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => {
      this.send(Uint8Array.of(7, 0)); // this page tells what it has drawn
      this.send(Uint8Array.of(1, this.rate));
      this.onState(true, 'Connected');
    };
    socket.onmessage = ({ data }) => {
      this.received += data.byteLength;
      this.handlers.get(new Uint8Array(data, 0, 1)[0])?.(data);
    };
    socket.onclose = () => {
      this.onState(false, 'No connection; is the server running, and is the address complete?');
      setTimeout(() => this.connect(), kRetry);
    };
    this.socket = socket;
  }
}
