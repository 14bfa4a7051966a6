// A short labelled clip of the slider as it swings between both sides.

import { move } from './motion';

/** The duration in milliseconds. */
const DURATION = 4000;
/** The frames per second. */
const RATE = 30;
/** How far the slider swings to both sides, in percent. */
const SWING = 42;

/** Records a clip. `picture`: draws a frame with the slider at a position in percent. Errors: the browser cannot record. */
export async function recordClip(picture: (percent: number, canvas: HTMLCanvasElement) => void): Promise<Blob> {
  if (typeof MediaRecorder === 'undefined') throw new Error('This browser cannot record clips; save a picture instead.');
  const canvas = document.createElement('canvas');
  picture(50, canvas);
  const type = ['video/webm;codecs=vp9', 'video/webm', 'video/mp4'].find((type) => MediaRecorder.isTypeSupported(type));
  const recorder = new MediaRecorder(canvas.captureStream(RATE), { mimeType: type, videoBitsPerSecond: 6e6 });
  const chunks: Blob[] = [];
  recorder.addEventListener('dataavailable', ({ data }) => chunks.push(data));
  const end = new Promise((resolve) => recorder.addEventListener('stop', resolve));
  recorder.start();
  await move(DURATION, (done) => picture(50 + SWING * Math.sin(2 * Math.PI * done), canvas));
  recorder.stop();
  await end;
  return new Blob(chunks, { type });
}
