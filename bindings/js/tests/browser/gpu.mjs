// A WebGPU device for tests that run in a page.

/** A WebGPU device with a list of its errors and functions for its buffers; null without an adapter. */
export async function gpu() {
  const adapter = await navigator.gpu?.requestAdapter();
  if (!adapter) return null;
  const device = await adapter.requestDevice();
  const errors = [];
  device.addEventListener('uncapturederror', ({ error }) => errors.push(error.message));
  const { STORAGE, COPY_DST, COPY_SRC, MAP_READ } = GPUBufferUsage;
  const filled = (array) => {
    const buffer = device.createBuffer({ size: 4 * Math.ceil(array.byteLength / 4), usage: STORAGE | COPY_DST | COPY_SRC });
    device.queue.writeBuffer(buffer, 0, array);
    return buffer;
  };
  /** Records, and reads the buffers' words. */
  const read = async (record, buffers) => {
    const encoder = device.createCommandEncoder();
    record(encoder);
    const copies = buffers.map((buffer) => {
      const copy = device.createBuffer({ size: buffer.size, usage: COPY_DST | MAP_READ });
      encoder.copyBufferToBuffer(buffer, 0, copy, 0, buffer.size);
      return copy;
    });
    device.queue.submit([encoder.finish()]);
    return Promise.all(copies.map(async (copy) => {
      await copy.mapAsync(GPUMapMode.READ);
      return new Uint32Array(copy.getMappedRange().slice(0));
    }));
  };
  return { device, errors, filled, read };
}
