#include "run.h"

#include <irrlicht.h>

using namespace irr;

static scene::IMeshManipulator *manipulator;

static const char *compute(const Case *c, float *tangents) {
    if (const char *reason = not_plain(c)) return reason;
    if (c->vertices > 65536) return "at most 65,536 vertices";
    scene::SMeshBuffer *buffer = new scene::SMeshBuffer;
    for (size_t vertex = 0; vertex < c->vertices; ++vertex) {
        const float *p = c->positions + 3 * vertex, *n = c->normals + 3 * vertex, *uv = c->uvs + 2 * vertex;
        buffer->Vertices.push_back(video::S3DVertex(p[0], p[1], p[2], n[0], n[1], n[2], video::SColor(255, 255, 255, 255), uv[0], uv[1]));
    }
    for (size_t corner = 0; corner < c->corners; ++corner) buffer->Indices.push_back((u16)c->indices[corner]);
    scene::SMesh *mesh = new scene::SMesh;
    mesh->addMeshBuffer(buffer);
    buffer->drop();
    scene::IMesh *made = manipulator->createMeshWithTangents(mesh, false, true); /* keeps normals, smooths */
    mesh->drop();
    scene::IMeshBuffer *found = made->getMeshBuffer(0);
    const video::S3DVertexTangents *vertices = (const video::S3DVertexTangents *)found->getVertices();
    for (size_t corner = 0; corner < c->corners; ++corner) {
        const video::S3DVertexTangents &vertex = vertices[found->getIndices()[corner]];
        const float t[3] = {vertex.Tangent.X, vertex.Tangent.Y, vertex.Tangent.Z};
        const float b[3] = {vertex.Binormal.X, vertex.Binormal.Y, vertex.Binormal.Z};
        /* Irrlicht's v points down. */
        const float row[4] = {t[0], t[1], t[2], -sign_of(c->normals + 3 * c->indices[corner], t, b)};
        memcpy(tangents + 4 * corner, row, sizeof row);
    }
    made->drop();
    return NULL;
}

int main(int count, char **arguments) {
    SIrrlichtCreationParameters parameters;
    parameters.DriverType = video::EDT_NULL;
    parameters.LoggingLevel = ELL_NONE;
    IrrlichtDevice *device = createDeviceEx(parameters);
    if (!device) { fprintf(stderr, "Irrlicht cannot start\n"); return 1; }
    manipulator = device->getSceneManager()->getMeshManipulator();
    return run(count, arguments, compute);
}
