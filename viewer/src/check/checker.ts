// A thread of its own for the check, whose runs on large models take seconds: the other thread goes on serving the view meanwhile.

import { check, fix, ready, type Finding } from 'darboux/check';

import { answer } from '../worker/calls';
import { judgeMaps, type JudgedMap } from './judge-maps';

/** Where texels and faces do not tell inverted green from inverted red, green is repaired: the page shows both pictures, and a person decides. */
const OPTIONS = { assume: 'directx' } as const;

/** The functions that the page can call. `file`: a self-contained GLB. */
const functions = {
  /** What is wrong with a model. */
  check(file: Uint8Array): Finding[] {
    return check(file, OPTIONS);
  },

  /** Repairs a model. The file is null where nothing was repaired. */
  repair(file: Uint8Array): { file: Uint8Array<ArrayBuffer> | null; findings: Finding[] } {
    return fix(file, OPTIONS);
  },

  /** Decodes the normal maps of a model and judges them. */
  judgeMaps(file: Uint8Array<ArrayBuffer>): Promise<JudgedMap[]> {
    return judgeMaps(file);
  },
};

export type CheckerFunctions = typeof functions;

answer(functions, ready);
