// Checks outputs of `darboux tangents` with tools that are not ours: node check.mjs REPORT.json... (its --json reports).
//
// For each written file: the Khronos validator finds no kind of error that the input did not have, and no more objects without a
// use; glTF-Transform reads the same content from input and output: every corner of every primitive, morph targets included, apart from tangents;
// animations, skins and images; and the JSON apart from where vertex data lies. A file may fail only where the validator
// finds errors in its input too. A file that became glTF has no error, but for normals that its source has, which are kept.
import { readFileSync } from 'node:fs';
import { basename, dirname, resolve } from 'node:path';
import { isDeepStrictEqual } from 'node:util';
import { GLB_BUFFER, Logger, NodeIO, Verbosity } from '@gltf-transform/core';
import { ALL_EXTENSIONS } from '@gltf-transform/extensions';
import draco3d from 'draco3dgltf';
import validator from 'gltf-validator';
import { MeshoptDecoder } from 'meshoptimizer';

const COMPRESSION = ['EXT_meshopt_compression', 'KHR_meshopt_compression', 'KHR_draco_mesh_compression'];

const io = new NodeIO()
	.setLogger(new Logger(Verbosity.SILENT))
	.registerExtensions(ALL_EXTENSIONS)
	.registerDependencies({
		'draco3d.decoder': await draco3d.createDecoderModule(),
		'meshopt.decoder': MeshoptDecoder,
	});

const reports = process.argv.slice(2).map((path) => JSON.parse(readFileSync(path, 'utf8')));
const counts = { same: 0, imported: 0, refused: 0, primitives: 0, corners: 0 };
const faults = [];
for (const file of reports.flatMap((report) => report.files)) {
	try {
		await check(file);
	} catch (error) {
		faults.push(`${file.input}: ${error.message}`);
	}
}
console.log(
	`${counts.same} outputs equal to their inputs apart from tangents and as valid ` +
		`(${counts.primitives} primitives, ${counts.corners} corners), ` +
		`${counts.imported} valid outputs of other formats, ${counts.refused} bad inputs refused`
);
for (const fault of faults) console.error(fault);
process.exit(faults.length ? 1 : 0);

async function check(file) {
	if (!/\.(gltf|glb|vrm)$/i.test(file.input)) {
		await checkImported(file);
		return;
	}
	const input = load(file.input);
	const { errors: inputErrors, unused: unusedBefore } = await findingsOf(input);
	if (!file.output) {
		expect(inputErrors.size, `refused (${file.error}), but the validator finds no error in it`);
		counts.refused++;
		return;
	}
	const output = load(file.output);
	const { errors, unused } = await findingsOf(output);
	for (const error of errors) expect(inputErrors.has(error), `the output has a new error: ${error}`);
	expect(unused <= unusedBefore, `${unused} objects have no use; in the input ${unusedBefore} had none`);
	const [before, after] = [await read(input), await read(output)];
	comparePrimitives(before, after);
	compareAnimationsAndSkins(before, after);
	compareImages(before, after);
	compareJson(input.json, output.json);
	expectTangents(file, after);
	counts.same++;
}

async function checkImported(file) {
	expect(file.output, `refused: ${file.error}`);
	const output = load(file.output);
	const { errors } = await findingsOf(output);
	for (const error of errors) {
		expect(error.startsWith('ACCESSOR_VECTOR3_NON_UNIT') && error.endsWith('NORMAL'), `the output has an error: ${error}`);
	}
	expectTangents(file, await read(output));
	counts.imported++;
}

function expect(condition, message) {
	if (!condition) throw new Error(message);
}

/** The file's bytes, its JSON, and the bytes of every resource that can be read. */
function load(path) {
	const bytes = new Uint8Array(readFileSync(path));
	const resources = {};
	let text = bytes;
	if (basename(path).toLowerCase().endsWith('.glb')) {
		const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
		const length = view.getUint32(12, true);
		text = bytes.subarray(20, 20 + length);
		const binary = 20 + length;
		if (binary + 8 <= bytes.length) {
			resources[GLB_BUFFER] = bytes.slice(binary + 8, binary + 8 + view.getUint32(binary, true));
		}
	}
	const json = JSON.parse(new TextDecoder().decode(text));
	for (const { uri } of [...(json.buffers ?? []), ...(json.images ?? [])]) {
		if (!uri || uri.startsWith('data:')) continue;
		try {
			resources[uri] = new Uint8Array(readFileSync(resolve(dirname(path), decodeURIComponent(uri))));
		} catch {
			resources[uri] = new Uint8Array(0);
		}
	}
	return { path, bytes, json, resources };
}

/** The kinds of errors that the Khronos validator finds, each with the role of the accessor it concerns, and how many objects nothing uses. */
async function findingsOf({ path, bytes, json, resources }) {
	const { issues } = await validator.validateBytes(bytes, {
		uri: basename(path),
		maxIssues: 0,
		externalResourceFunction: async (uri) => resources[uri] ?? Promise.reject(new Error('missing')),
	});
	const errors = issues.messages.filter((message) => message.severity === 0);
	return {
		errors: new Set(errors.map(({ code, pointer }) => `${code} at ${role(json, pointer ?? '')}`)),
		unused: issues.messages.filter(({ code }) => code === 'UNUSED_OBJECT').length,
	};
}

/** A JSON pointer; for accessors, which may move, the attributes that they are. */
function role(json, pointer) {
	const index = pointer.match(/^\/accessors\/(\d+)/)?.[1];
	if (index === undefined) return pointer.replace(/\d+/g, '#');
	const names = new Set();
	for (const primitive of (json.meshes ?? []).flatMap((mesh) => mesh.primitives ?? [])) {
		if (primitive.indices === Number(index)) names.add('indices');
		for (const attributes of [primitive.attributes ?? {}, ...(primitive.targets ?? [])]) {
			for (const name in attributes) if (attributes[name] === Number(index)) names.add(name);
		}
	}
	return `accessor of ${[...names].sort().join(', ')}`;
}

/** The file through glTF-Transform. Compression is undone by its decoders. */
async function read({ json, resources }) {
	return (await io.readJSON({ json: structuredClone(json), resources })).getRoot();
}

function comparePrimitives(before, after) {
	const primitives = (root) => root.listMeshes().flatMap((mesh) => mesh.listPrimitives());
	const [old, fresh] = [primitives(before), primitives(after)];
	expect(old.length === fresh.length, `${old.length} primitives became ${fresh.length}`);
	for (let i = 0; i < old.length; i++) {
		const [a, b] = [cornersOf(old[i]), cornersOf(fresh[i])];
		expect(a.kind === b.kind, `primitive ${i} became another kind of primitive`);
		expect(a.corners.length === b.corners.length, `primitive ${i} has another number of corners`);
		compareAttributes(old[i], fresh[i], a.corners, b.corners, `primitive ${i}`);
		const [targets, freshTargets] = [old[i].listTargets(), fresh[i].listTargets()];
		expect(targets.length === freshTargets.length, `primitive ${i} has another number of morph targets`);
		targets.forEach((target, t) =>
			compareAttributes(target, freshTargets[t], a.corners, b.corners, `primitive ${i}, morph target ${t}`)
		);
		counts.primitives++;
		counts.corners += a.corners.length;
	}
}

/** The vertices of a primitive's corners; strips and fans as the triangles that the specification says they are. */
function cornersOf(primitive) {
	const position = primitive.getAttribute('POSITION');
	const list = primitive.getIndices()?.getArray() ?? Array.from({ length: position?.getCount() ?? 0 }, (_, i) => i);
	const mode = primitive.getMode();
	if (mode < 4) return { kind: mode, corners: list };
	if (mode === 4) return { kind: 'triangles', corners: list };
	const corners = [];
	for (let i = 0; i + 2 < list.length; i++) {
		if (mode === 5) corners.push(list[i], list[i + 1 + (i % 2)], list[i + 2 - (i % 2)]);
		else corners.push(list[i + 1], list[i + 2], list[0]);
	}
	return { kind: 'triangles', corners };
}

function compareAttributes(old, fresh, oldCorners, freshCorners, where) {
	const names = (holder) => holder.listSemantics().filter((name) => name !== 'TANGENT');
	expect(isDeepStrictEqual(names(old).sort(), names(fresh).sort()), `${where} has other attributes`);
	for (const name of names(old)) {
		const [a, b] = [elements(old.getAttribute(name)), elements(fresh.getAttribute(name))];
		expect(a.type === b.type, `${name} of ${where} changed its type`);
		for (let i = 0; i < oldCorners.length; i++) {
			expect(a.at(oldCorners[i]).equals(b.at(freshCorners[i])), `${name} of ${where} differs at corner ${i}`);
		}
	}
}

/** An accessor's element type and its elements as bytes. */
function elements(accessor) {
	const array = accessor.getArray();
	const size = accessor.getElementSize() * array.BYTES_PER_ELEMENT;
	const bytes = Buffer.from(array.buffer, array.byteOffset, array.byteLength);
	return {
		type: [accessor.getType(), accessor.getComponentType(), accessor.getNormalized()].join(),
		at: (index) => bytes.subarray(index * size, (index + 1) * size),
	};
}

function compareAnimationsAndSkins(before, after) {
	const accessors = (root) => [
		...root.listAnimations().flatMap((animation) =>
			animation.listSamplers().flatMap((sampler) => [sampler.getInput(), sampler.getOutput()])
		),
		...root.listSkins().map((skin) => skin.getInverseBindMatrices()),
	];
	const [old, fresh] = [accessors(before), accessors(after)];
	expect(old.length === fresh.length, 'animations or skins were added or lost');
	old.forEach((accessor, i) =>
		expect(isDeepStrictEqual(accessor?.getArray(), fresh[i]?.getArray()), 'animation or skin data changed')
	);
}

function compareImages(before, after) {
	const images = (root) => root.listTextures().map((texture) => Buffer.from(texture.getImage() ?? []));
	expect(isDeepStrictEqual(images(before), images(after)), 'images changed');
}

/** The JSON is the same, key order included, apart from where vertex data and images lie. */
function compareJson(old, fresh) {
	const [a, b] = [old, fresh].map((json) => JSON.stringify(withoutPlaces(structuredClone(json)), null, 1).split('\n'));
	const line = a.findIndex((text, i) => text !== b[i]);
	expect(line < 0 && a.length === b.length, `the JSON differs: ${a[line]?.trim()} became ${b[line]?.trim()}`);
}

function withoutPlaces(json) {
	for (const key of ['accessors', 'bufferViews', 'buffers']) delete json[key];
	for (const key of ['extensionsUsed', 'extensionsRequired']) {
		json[key] = json[key]?.filter((name) => !COMPRESSION.includes(name));
		if (!json[key]?.length) delete json[key];
	}
	for (const skin of json.skins ?? []) delete skin.inverseBindMatrices;
	for (const sampler of (json.animations ?? []).flatMap((animation) => animation.samplers ?? [])) {
		for (const key of ['input', 'output']) delete sampler[key];
	}
	for (const image of json.images ?? []) for (const key of ['uri', 'bufferView', 'mimeType']) delete image[key];
	for (const primitive of (json.meshes ?? []).flatMap((mesh) => mesh.primitives)) {
		for (const key of ['attributes', 'indices', 'mode', 'targets']) delete primitive[key];
		if (!primitive.extensions) continue;
		for (const name of COMPRESSION) delete primitive.extensions[name];
		if (!Object.keys(primitive.extensions).length) delete primitive.extensions;
	}
	return json;
}

/** Each primitive that the report says got tangents has them, all of them finite and of unit length. */
function expectTangents(file, root) {
	const meshes = root.listMeshes();
	for (const { mesh, primitive, outcome } of file.primitives) {
		if (outcome !== 'written') continue;
		const tangents = meshes[mesh].listPrimitives()[primitive].getAttribute('TANGENT');
		expect(tangents, `primitive ${primitive} of mesh ${mesh} got no TANGENT`);
		for (let i = 0; i < tangents.getCount(); i++) {
			const [x, y, z, w] = tangents.getElement(i, []);
			const unit = Math.abs(Math.hypot(x, y, z) - 1) < 1e-3 && Math.abs(w) === 1;
			expect(unit, `primitive ${primitive} of mesh ${mesh} has the tangent ${[x, y, z, w]} at vertex ${i}`);
		}
	}
}
