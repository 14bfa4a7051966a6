// The findings, one card per problem with all parts that have it: what is wrong, what it looks like, the cure, and the evidence on demand. Notes are folded.

import type { Finding } from 'darboux/check';

import type { Checked } from '../check/checker';
import { counted } from '../plural';
import { element } from './elements';
import { severityIcon } from './severity-icon';

const SEVERITIES = ['error', 'warning', 'info', 'not-checked'] as const;

const SEVERITY_NAMES = { error: 'Error', warning: 'Warning', info: 'Note', 'not-checked': 'Not checked' } as const;

/** Leads to the n-th place of a finding. Returns a sentence about it, and the number of places. */
export type Visit = (finding: Finding, n: number) => Promise<{ text: string; count: number }>;

/** Whether a repair would remove a finding. */
export function isRepairable({ fixable, repaired }: Finding): boolean {
  return fixable && repaired === undefined;
}

/** Says whether the check, the judgement of maps or a repair runs; screen readers and tests wait for its end. */
export function setBusy(isBusy: boolean): void {
  element('findings').ariaBusy = String(isBusy);
}

/** Clears the list and says that the check runs. */
export function showChecking(): void {
  element('findings').replaceChildren();
  element('diagnosis').replaceChildren();
  element('notes').hidden = true;
  setBusy(true);
  element('findings-summary').textContent = 'Checking the model and its normal maps …';
  for (const id of ['repair', 'make-normals', 'save-repaired']) element(id).hidden = true;
}

/** The parts of a card that are shown at once. */
const SHOWN_PARTS = 6;

/** Shows the diagnosis, and below it findings, the worst problem first. `before`: the diagnosis of the file that was repaired. */
export function showFindings({ findings, statements, diagnosis }: Checked, visit: Visit, before = ''): void {
  const done = before && before !== diagnosis ? `${forPage(before, true)} ` : '';
  element('diagnosis').replaceChildren(...inWords(done + forPage(diagnosis, false)));
  const problems = statements.map((numbers) => numbers.map((number) => findings[number]));
  const cards = problems.map((same) => ({ isNote: ['info', 'not-checked'].includes(same[0].severity), card: card(same, visit) }));
  const of = (isNote: boolean) => cards.filter((one) => one.isNote === isNote).map(({ card }) => card);
  element('findings').replaceChildren(...of(false));
  element('notes-list').replaceChildren(...of(true));
  element('notes').hidden = !of(true).length;
  element('notes-title').textContent = counted(of(true).length, 'note', 'notes');
  element('findings-summary').textContent = summary(findings);
  const isDone = findings.some(({ repaired }) => repaired !== undefined);
  element('repair').hidden = !findings.some(isRepairable) || isDone;
  element('make-normals').hidden = isDone || !findings.some((finding) => finding.code === 'normal-missing' && !isRepairable(finding));
  element('save-repaired').hidden = !isDone;
}

/** Says why there are no findings. */
export function showCheckFailed(reason: string): void {
  element('findings-summary').textContent = `The check ended early: ${reason}`;
}

function summary(findings: Finding[]): string {
  const names = { error: ['error', 'errors'], warning: ['warning', 'warnings'], info: ['note', 'notes'], 'not-checked': ['map not checked', 'maps not checked'] } as const;
  const parts = SEVERITIES.map((severity) => [findings.filter((finding) => finding.severity === severity).length, ...names[severity]] as const);
  const said = parts.filter(([count]) => count).map(([count, one, many]) => counted(count, one, many));
  const repaired = findings.filter((finding) => finding.repaired).length;
  if (!said.length) return 'Nothing is wrong.';
  return repaired ? `${said.join(', ')}; ${repaired} of them repaired.` : `${said.join(', ')}.`;
}

/** The card of one problem. `findings`: the same problem on several parts, at least one. */
function card(findings: Finding[], visit: Visit): HTMLElement {
  const [first, ...others] = findings;
  const item = document.createElement('li');
  item.dataset.code = first.code;
  item.dataset.severity = first.severity;
  const severity = text('strong', SEVERITY_NAMES[first.severity], 'severity');
  severity.prepend(severityIcon(first.severity));
  const sentence = `${placeOf(first)}: ${first.text}`;
  const more = others.length ? ` The same on ${counted(others.length, 'other part', 'other parts')}, below.` : '';
  const head = visiting(first, visit, [severity, text('span', `${sentence}.${more}`)]);
  item.append(head, ...became(first), paragraph('Looks like', first.looksLike), paragraph('Cure', first.cure), evidence(first));
  const rows = others.map((finding) => {
    const row = document.createElement('div');
    row.className = 'part';
    row.append(visiting(finding, visit, [text('span', `${placeOf(finding)}: ${finding.text}.`)]), ...became(finding), evidence(finding));
    return row;
  });
  item.append(...rows.slice(0, SHOWN_PARTS));
  if (rows.length > SHOWN_PARTS) {
    const rest = document.createElement('details');
    rest.append(text('summary', `${rows.length - SHOWN_PARTS} more`), ...rows.slice(SHOWN_PARTS));
    item.append(rest);
  }
  return item;
}

/** A button that leads to the places of a finding, one after the other. */
function visiting(finding: Finding, visit: Visit, content: HTMLElement[]): HTMLElement {
  const button = document.createElement('button');
  button.type = 'button';
  button.className = 'finding';
  button.append(...content);
  let next = 0;
  button.addEventListener('click', async () => {
    const { text, count } = await visit(finding, next);
    next = (next + 1) % Math.max(count, 1);
    element('status').textContent = text;
  });
  return button;
}

/** What the repair did. */
function became({ repaired, leftBecause }: Finding): HTMLElement[] {
  if (repaired === undefined) return [];
  const sentence = repaired ? '✓ Repaired.' : `– Left, because ${leftBecause ?? 'nothing was repaired'}.`;
  return [text('p', sentence, repaired ? 'repaired' : 'left')];
}

/** Where a finding is, in words. */
export function placeOf({ source, mesh, meshName, primitive, sameAs, material, image }: Finding): string {
  const same = sameAs ? ` and ${sameAs} with the same data` : '';
  if (mesh !== null) return `${source ?? meshName ?? `Mesh ${mesh}`}${primitive ? `, primitive ${primitive}` : ''}${same}`;
  if (image !== null) return `Image ${image}`;
  return material === null ? 'The image' : `Material ${material}`;
}

function evidence({ code, count, first, firstAre, evidence: numbers, leftBecause, repaired }: Finding): HTMLElement {
  const details = document.createElement('details');
  const list = document.createElement('dl');
  const add = (what: string, value: string) => list.append(text('dt', what), text('dd', value));
  add('Code', code);
  add('Count', count.toLocaleString('en'));
  if (first.length) add(`First ${firstAre}`, first.join(', '));
  for (const { what, value, unit } of numbers) add(what, `${value.toLocaleString('en', { maximumSignificantDigits: 4 })} ${unit}`.trim());
  if (leftBecause !== null && repaired === undefined) add('Not repaired here, because', leftBecause);
  details.append(text('summary', 'Evidence'), list);
  return details;
}

function paragraph(label: string, sentence: string): HTMLElement {
  const out = document.createElement('p');
  out.append(text('b', `${label}: `), ...inWords(sentence));
  return out;
}

/** A sentence in which names of commands are between backticks. */
function inWords(sentence: string): (HTMLElement | string)[] {
  return sentence.split('`').map((part, at) => (at % 2 ? text('code', part) : part));
}

/** What the page assumes of every map, and tells where a repair depends on it. */
const ASSUMPTION = / Where nothing shows the convention of a map, it was taken to be [^.]*\./;

/** The diagnosis with the page's button in place of the command that does the same. */
function forPage(diagnosis: string, isDone: boolean): string {
  return diagnosis
    .replace(ASSUMPTION, '')
    .replace(/Type `darboux check FILE[^`]* --fix` to repair it\./, isDone ? '' : 'Press Repair.')
    .replace(/`darboux check FILE[^`]* --fix` repairs/, 'Repair mends')
    .trim();
}

function text(tag: string, content: string, className = ''): HTMLElement {
  const out = document.createElement(tag);
  out.textContent = content;
  if (className) out.className = className;
  return out;
}
