// Reads cases and writes results, for adapters in Java 17. Copy it. Licence: CC0.

import java.io.IOException;
import java.nio.file.Files;
import java.nio.file.Path;
import java.util.Locale;
import java.util.regex.Pattern;
import java.util.stream.Stream;

/** A case. Numbers are read from the member "bits", whose hexadecimal words need no parsing of decimals. */
public class Case {
    public final String name;
    /** Degrees. */
    public final float threshold;
    /** 3, 3 and 2 numbers per vertex. */
    public final float[] positions, normals, uvs;
    /** Corners per face; vertex of each corner. */
    public final int[] faces, indices;

    Case(String name, String text) {
        this.name = name;
        String bits = text.substring(text.indexOf("\"bits\":"));
        threshold = floats(bits, "threshold")[0];
        positions = floats(bits, "positions");
        normals = floats(bits, "normals");
        uvs = floats(bits, "uvs");
        faces = integers(text, "faces");
        indices = integers(text, "indices");
    }

    /** The text of a member: up to the next key or the end. */
    private static String member(String text, String key) {
        int start = text.indexOf('"' + key + "\":") + key.length() + 3;
        var next = Pattern.compile("\"\\w+\":").matcher(text);
        return text.substring(start, next.find(start) ? next.start() : text.length());
    }

    private static float[] floats(String text, String key) {
        var words = Pattern.compile("\"([0-9a-f]{8})\"").matcher(member(text, key)).results().toList();
        float[] out = new float[words.size()];
        for (int at = 0; at < out.length; at++) out[at] = Float.intBitsToFloat(Integer.parseUnsignedInt(words.get(at).group(1), 16));
        return out;
    }

    private static int[] integers(String text, String key) {
        return Pattern.compile("\\d+").matcher(member(text, key)).results().mapToInt(match -> Integer.parseInt(match.group())).toArray();
    }

    /** True if all faces are triangles. */
    public boolean isTriangles() {
        for (int size : faces) if (size != 3) return false;
        return true;
    }

    /** Tangents, four numbers each: per corner, or per vertex where indices are the vertices of the corners. */
    public record Found(float[] tangents, int[] indices) {}

    /** Why a case cannot be run. */
    public static class Skip extends Exception {
        public Skip(String reason) { super(reason); }
    }

    public interface Compute {
        Found compute(Case mesh) throws Skip;
    }

    /** The repetitions of cases with many corners, of which the fastest counts, in processor time. */
    private static final int REPETITIONS = 5, MANY_CORNERS = 1000;

    /** Runs an adapter on every case of a folder. */
    public static void run(Path cases, Path results, Compute compute) throws IOException {
        Files.createDirectories(results);
        try (Stream<Path> paths = Files.list(cases)) {
            for (Path path : paths.filter(path -> path.toString().endsWith(".json")).sorted().toList()) {
                String name = path.getFileName().toString();
                Files.writeString(results.resolve(name), result(new Case(name, Files.readString(path)), compute));
            }
        }
    }

    private static String result(Case mesh, Compute compute) {
        var clock = java.lang.management.ManagementFactory.getThreadMXBean();
        Found found = null;
        long least = Long.MAX_VALUE;
        try {
            for (int round = 0; round < (mesh.indices.length > MANY_CORNERS ? REPETITIONS : 1); round++) {
                long start = clock.getCurrentThreadCpuTime();
                found = compute.compute(mesh);
                least = Math.min(least, clock.getCurrentThreadCpuTime() - start);
            }
        } catch (Skip skip) {
            return "{\"skipped\": \"" + skip.getMessage() + "\"}\n";
        }
        var text = new StringBuilder(String.format(Locale.ROOT, "{\"seconds\": %.9f, \"tangents\": [", least / 1e9));
        for (int at = 0; at < found.tangents.length; at++) {
            text.append(at % 4 > 0 ? ", " : at > 0 ? "],\n[" : "[").append(number(found.tangents[at]));
        }
        text.append(found.tangents.length > 0 ? "]]" : "]");
        if (found.indices != null) text.append(", \"indices\": ").append(java.util.Arrays.toString(found.indices));
        return text.append("}\n").toString();
    }

    private static String number(float x) {
        return Float.isFinite(x) ? Float.toString(x) : Float.isNaN(x) ? "\"nan\"" : x > 0 ? "\"inf\"" : "\"-inf\"";
    }
}
