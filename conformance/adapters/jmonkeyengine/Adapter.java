import com.jme3.scene.Mesh;
import com.jme3.scene.VertexBuffer.Type;
import com.jme3.util.BufferUtils;
import com.jme3.util.mikktspace.MikkTSpaceContext;
import com.jme3.util.mikktspace.MikktspaceTangentGenerator;
import java.nio.FloatBuffer;
import java.nio.file.Path;
import java.util.Arrays;
import java.util.logging.Level;
import java.util.logging.Logger;

public class Adapter {
    public static void main(String[] arguments) throws Exception {
        Logger.getLogger("").setLevel(Level.OFF);
        Case.run(Path.of(arguments[1]), Path.of(arguments[2]), arguments[0].equals("core") ? Adapter::core : Adapter::mesh);
    }

    /** The translation of mikktspace.c, per corner. Its source says that quads are not supported. */
    static Case.Found core(Case mesh) throws Case.Skip {
        if (!mesh.isTriangles()) throw new Case.Skip("triangles only");
        var corners = new Corners(mesh);
        try {
            MikktspaceTangentGenerator.genTangSpace(corners, mesh.threshold);
        } catch (RuntimeException error) {
            return failed(mesh, error);
        }
        return new Case.Found(corners.tangents, null);
    }

    /** What the engine calls for a mesh: one tangent per vertex. */
    static Case.Found mesh(Case given) throws Case.Skip {
        if (!given.isTriangles()) throw new Case.Skip("triangles only");
        if (given.threshold != 180.0f) throw new Case.Skip("no angular threshold");
        if (given.faces.length == 0) throw new Case.Skip("no meshes without triangles");
        var mesh = new Mesh();
        mesh.setBuffer(Type.Position, 3, given.positions);
        mesh.setBuffer(Type.Normal, 3, given.normals);
        mesh.setBuffer(Type.TexCoord, 2, given.uvs);
        mesh.setBuffer(Type.Index, 3, given.indices);
        try {
            MikktspaceTangentGenerator.generate(mesh);
        } catch (RuntimeException error) {
            return failed(given, error);
        }
        float[] tangents = BufferUtils.getFloatArray((FloatBuffer) mesh.getBuffer(Type.Tangent).getData());
        for (int at = 3; at < tangents.length; at += 4) tangents[at] = -tangents[at];
        return new Case.Found(tangents, given.indices);
    }

    private static Case.Found failed(Case mesh, RuntimeException error) {
        System.err.println(mesh.name + ": " + error);
        float[] tangents = new float[4 * mesh.indices.length];
        Arrays.fill(tangents, Float.NaN);
        return new Case.Found(tangents, null);
    }

    private static class Corners implements MikkTSpaceContext {
        final Case mesh;
        final int[] firstCorners;
        final float[] tangents;

        Corners(Case mesh) {
            this.mesh = mesh;
            tangents = new float[4 * mesh.indices.length];
            firstCorners = new int[mesh.faces.length];
            for (int face = 1; face < firstCorners.length; face++) firstCorners[face] = firstCorners[face - 1] + mesh.faces[face - 1];
            for (int corner = 0; corner < mesh.indices.length; corner++) {
                tangents[4 * corner] = 1.0f;
                tangents[4 * corner + 3] = -1.0f;
            }
        }

        private void read(float[] out, float[] rows, int width, int face, int corner) {
            System.arraycopy(rows, width * mesh.indices[firstCorners[face] + corner], out, 0, width);
        }

        @Override public int getNumFaces() { return mesh.faces.length; }
        @Override public int getNumVerticesOfFace(int face) { return mesh.faces[face]; }
        @Override public void getPosition(float[] out, int face, int corner) { read(out, mesh.positions, 3, face, corner); }
        @Override public void getNormal(float[] out, int face, int corner) { read(out, mesh.normals, 3, face, corner); }
        @Override public void getTexCoord(float[] out, int face, int corner) { read(out, mesh.uvs, 2, face, corner); }

        @Override public void setTSpaceBasic(float[] tangent, float sign, int face, int corner) {
            int at = 4 * (firstCorners[face] + corner);
            System.arraycopy(tangent, 0, tangents, at, 3);
            tangents[at + 3] = -sign; // jMonkeyEngine's signs are those for v down
        }

        @Override public void setTSpace(float[] t, float[] b, float magS, float magT, boolean preserves, int face, int corner) {}
    }
}
