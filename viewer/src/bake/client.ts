// The page's side of the thread that bakes: one bake at a time, the latest request last, and an end at any time.

import { callerOf, type Caller } from '../worker/client';
import type { BakerFunctions, BakerOptions, ShownBake } from './baker';

/** The models of a bake, as self-contained GLBs. */
export interface BakedModels {
  low: Uint8Array;
  high: Uint8Array[];
}

export class Baker {
  private worker: Worker | null = null;
  private call: Caller<BakerFunctions> | null = null;
  private opened: BakedModels | null = null;

  /** `progress` receives the finished part of the running bake, from 0 to 1. */
  constructor(private readonly progress: (done: number) => void) {}

  /** Bakes the models, which are sent to the thread only when they changed. */
  async bake(models: BakedModels, options: BakerOptions): Promise<ShownBake> {
    this.worker ??= new Worker(new URL('./baker.ts', import.meta.url), { type: 'module' });
    this.call ??= callerOf<BakerFunctions>(this.worker, this.progress);
    if (this.opened !== models) await this.call('open', models.low, models.high);
    this.opened = models;
    return this.call('bake', options);
  }

  /** Ends the thread. A running bake never resolves. */
  cancel(): void {
    this.worker?.terminate();
    [this.worker, this.call, this.opened] = [null, null, null];
  }
}
