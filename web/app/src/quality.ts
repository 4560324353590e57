// How finely the picture is drawn: as finely as this machine does in time.

export interface Look {
  ratio: number;      // pixels drawn along a pixel of the page
  shadows: boolean;
  fine: boolean;      // paper that shines a little, lit by a room; else matt, lit by a sky
  numbers: number;    // milliseconds between two drawings of plots and numbers
}

/** From the finest down. Fewer pixels than the page has do not help: a graphics processor has them for nothing, and without
 *  one it is the whole page that costs. */
export const looks: Look[] = [
  { ratio: 2, shadows: true, fine: true, numbers: 70 },
  { ratio: 1, shadows: true, fine: true, numbers: 70 },
  { ratio: 1, shadows: false, fine: true, numbers: 200 },
  { ratio: 1, shadows: false, fine: false, numbers: 400 },
];
/** Of what stands still where there is no graphics processor: smooth edges. */
const softwareStill: Look = { ratio: 2, shadows: false, fine: false, numbers: 400 };

const late = 20, inTime = 17.5;   // milliseconds of a frame
const some = 8;                   // frames that are judged together, by the median: one that stalls is no reason
const calm = 15;                  // such groups in time before a finer look is tried
const quiet = 20;                 // frames in which nothing moves: it stands still

export class Quality {
  private times: number[] = [];
  private good = 0;
  private wait = calm;
  private unmoved = 0;
  private tried = false;   // is this look finer than one before
  level: number;
  fixed: Look | null = null;   // for measurements

  constructor(private readonly software: boolean) { this.level = software ? looks.length - 1 : 0; }

  /** What to draw the next frame by. */
  look(moves: boolean): Look {
    this.unmoved = moves ? 0 : this.unmoved + 1;
    if (this.fixed) return this.fixed;
    if (this.unmoved <= quiet) return looks[this.level];
    return this.software ? softwareStill : looks[0];
  }

  /** A frame of what moves took so many milliseconds. A finer look that was too slow is tried again later and later. */
  took(milliseconds: number) {
    this.times.push(milliseconds);
    if (this.times.length < some) return;
    const median = this.times.sort((a, b) => a - b)[some / 2];
    this.times = [];
    this.good = median <= inTime ? this.good + 1 : 0;
    if (median > late && this.level + 1 < looks.length) {
      if (this.tried) this.wait *= 4;
      this.tried = false;
      this.level += 1;
    } else if (this.good >= this.wait && this.level > 0) {
      this.tried = true;
      this.level -= 1;
      this.good = 0;
    }
  }
}

/** Does WebGL draw without a graphics processor here? */
export function drawsInSoftware(): boolean {
  const gl = document.createElement('canvas').getContext('webgl2');
  if (!gl) return true;
  const info = gl.getExtension('WEBGL_debug_renderer_info');
  const name = String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  gl.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}
