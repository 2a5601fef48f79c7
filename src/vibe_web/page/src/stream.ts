// The connection to the server: messages by kind, commands, whether the link is alive, and a new try when it is lost.

import { Kind } from './messages';

const kRetry = 1000; // [ms]
const kAsk = 500; // time of the server [ms]
const kPatience = 4; // questions without an answer, after which the link counts as silent
const kSentences = [403, 503]; // statuses whose text the server writes for people
const kAnswers = 20; // of which the quickest compares the clocks: a clock that is set right counts after 10 s

export class Stream {
  private socket: WebSocket | null = null;
  private handlers = new Map<Kind, (bytes: ArrayBuffer) => void>();
  received = 0; // [bytes]
  private unanswered = Infinity; // questions since the last message, which a page that is busy for a while does not ask; Infinity: there is no connection
  private answers: { took: number; ahead: number }[] = []; // took how long; the clock of the server is how far ahead [ms]

  /** @param onState  whether there is a connection, and else why not in one sentence; empty: it is being made */
  constructor(private token: string, private rate: number, private onState: (open: boolean, why: string) => void) {
    this.connect();
    this.on(Kind.Pong, (bytes) => this.compareClocks(new Float64Array(bytes, 8, 2)));
    setInterval(() => this.askTime(), kAsk);
  }

  /** Time of the server, by a steady clock [ms]. */
  get now() {
    return performance.now() + this.quickest.ahead;
  }

  /** For how long nothing has come, though answers are asked for all the time; 0: not for long [ms]. */
  get silence() {
    return this.unanswered < kPatience ? 0 : kAsk * this.unanswered;
  }

  private get quickest() {
    return this.answers.reduce((best, each) => (each.took < best.took ? each : best), { took: Infinity, ahead: NaN });
  }

  private askTime() {
    this.unanswered++;
    const bytes = new ArrayBuffer(16), view = new DataView(bytes);
    view.setUint8(0, 6);
    view.setFloat64(8, performance.now(), true);
    this.send(bytes);
  }

  private compareClocks([asked, time]: Float64Array) {
    const now = performance.now(), took = now - asked;
    this.answers = [...this.answers.slice(1 - kAnswers), { took, ahead: 1000 * time + took / 2 - now }];
  }

  on(kind: Kind, handler: (bytes: ArrayBuffer) => void) {
    this.handlers.set(kind, handler);
  }

  send(bytes: ArrayBuffer | Uint8Array) {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(bytes);
  }

  /** For good. */
  close() {
    if (this.socket) this.socket.onclose = null;
    this.socket?.close();
  }

  private connect() {
    const address = new URL('stream', location.href);
    address.protocol = location.protocol === 'https:' ? 'wss:' : 'ws:';
    address.hash = '';
    address.search = this.token ? '?token=' + encodeURIComponent(this.token) : '';
    const socket = new WebSocket(address);
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => {
      this.unanswered = 0;
      this.answers = [];
      this.send(Uint8Array.of(7, 0)); // this page tells what it has drawn
      this.send(Uint8Array.of(1, this.rate));
      this.askTime();
      this.onState(true, '');
    };
    socket.onmessage = ({ data }) => {
      this.unanswered = 0;
      this.received += data.byteLength;
      this.handlers.get(new Uint8Array(data, 0, 1)[0])?.(data);
    };
    socket.onclose = () => {
      this.unanswered = Infinity;
      this.onState(false, '');
      void this.askWhy(address.search).then((why) => {
        this.onState(false, why);
        setTimeout(() => this.connect(), kRetry);
      });
    };
    this.socket = socket;
  }

  /** A browser does not tell why a stream is refused, but the server says it to a plain request. */
  private async askWhy(search: string): Promise<string> {
    try {
      const { status, text } = await fetch('stream' + search, { signal: AbortSignal.timeout(2 * kRetry) }).then(async (answer) => ({ status: answer.status, text: await answer.text() }));
      if (status === 426) return 'The server answers, but its stream does not open; what is in between, such as a proxy, has to pass on WebSockets with their Origin and Host.';
      return kSentences.includes(status) ? text.trim() : `${location.host} answers without the stream (status ${status}); is web_node running, and is the address complete?`;
    } catch {
      return `Nothing answers at ${location.host}; is web_node running, and is this machine in its network?`;
    }
  }
}
