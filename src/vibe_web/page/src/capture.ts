// Pictures and videos of what is shown, as files of the browser.

function save(content: Blob, name: string) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(content);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

const stamp = () => new Date().toISOString().replace(/[:.]/g, '-');

/** Call it right after drawing: a canvas forgets its picture. */
export function savePicture(canvas: HTMLCanvasElement) {
  canvas.toBlob((blob) => blob && save(blob, `vibe-${stamp()}.png`));
}

export class VideoRecorder {
  private recorder: MediaRecorder | null = null;

  constructor(private canvas: HTMLCanvasElement) {}

  get running() {
    return this.recorder?.state === 'recording';
  }

  toggle() {
    if (this.running) return this.recorder!.stop();
    const chunks: Blob[] = [];
    this.recorder = new MediaRecorder(this.canvas.captureStream(30));
    this.recorder.ondataavailable = ({ data }) => chunks.push(data);
    this.recorder.onstop = () => save(new Blob(chunks, { type: 'video/webm' }), `vibe-${stamp()}.webm`);
    this.recorder.start(1000);
  }
}
