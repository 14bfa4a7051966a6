// A thread of its own for the check, whose runs on large models take seconds: the other thread goes on serving the view meanwhile.

import { check, fix, ready, type Finding, type Findings } from 'darboux/check';

import { answer } from '../worker/calls';
import { judgeMaps, type JudgedMap } from './judge-maps';

/** Where texels and faces do not tell inverted green from inverted red, green is repaired: the page shows both pictures, and a person decides. */
const OPTIONS = { assume: 'directx' } as const;

/** The findings of a file, with what happened to it. Arrays lose their further properties between threads. */
export interface Checked {
  findings: Finding[];
  /** The indices of findings that say the same of several places, together, the worst first. */
  statements: number[][];
  /** What happened, what it looks like and what to do, in one to three sentences. */
  diagnosis: string;
}

/** The functions that the page can call. `file`: a self-contained GLB. */
const functions = {
  /** What is wrong with a model. */
  check(file: Uint8Array): Checked {
    return checked(check(file, OPTIONS));
  },

  /** Repairs a model. The file is null where nothing was repaired. */
  repair(file: Uint8Array): Checked & { file: Uint8Array<ArrayBuffer> | null } {
    const fixed = fix(file, OPTIONS);
    return { file: fixed.file, ...checked(fixed.findings) };
  },

  /** Decodes the normal maps of a model and judges them. */
  judgeMaps(file: Uint8Array<ArrayBuffer>): Promise<JudgedMap[]> {
    return judgeMaps(file);
  },
};

function checked(findings: Findings): Checked {
  return { findings: [...findings], statements: findings.statements, diagnosis: findings.diagnosis };
}

export type CheckerFunctions = typeof functions;

answer(functions, ready);
