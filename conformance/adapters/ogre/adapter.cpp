#include "run.h"

#include <OgreDefaultHardwareBufferManager.h>
#include <OgreHardwareBuffer.h>
#include <OgreHardwareIndexBuffer.h>
#include <OgreHardwareVertexBuffer.h>
#include <OgreLogManager.h>
#include <OgreTangentSpaceCalc.h>
#include <OgreVertexIndexData.h>

using namespace Ogre;

enum { ROW = 8 }; /* numbers per vertex: position, normal, uv */

static VertexData *vertices_of(const Case *c) {
    VertexData *data = new VertexData;
    data->vertexDeclaration->addElement(0, 0, VET_FLOAT3, VES_POSITION);
    data->vertexDeclaration->addElement(0, 12, VET_FLOAT3, VES_NORMAL);
    data->vertexDeclaration->addElement(0, 24, VET_FLOAT2, VES_TEXTURE_COORDINATES, 0);
    std::vector<float> rows;
    for (size_t vertex = 0; vertex < c->vertices; ++vertex) {
        rows.insert(rows.end(), c->positions + 3 * vertex, c->positions + 3 * vertex + 3);
        rows.insert(rows.end(), c->normals + 3 * vertex, c->normals + 3 * vertex + 3);
        rows.insert(rows.end(), c->uvs + 2 * vertex, c->uvs + 2 * vertex + 2);
    }
    auto buffer = HardwareBufferManager::getSingleton().createVertexBuffer(4 * ROW, c->vertices, HardwareBuffer::HBU_DYNAMIC);
    buffer->writeData(0, buffer->getSizeInBytes(), rows.data());
    data->vertexBufferBinding->setBinding(0, buffer);
    data->vertexCount = c->vertices;
    return data;
}

static IndexData *indices_of(const Case *c) {
    IndexData *data = new IndexData;
    data->indexBuffer = HardwareBufferManager::getSingleton().createIndexBuffer(HardwareIndexBuffer::IT_32BIT, c->corners, HardwareBuffer::HBU_DYNAMIC);
    data->indexBuffer->writeData(0, data->indexBuffer->getSizeInBytes(), c->indices);
    data->indexCount = c->corners;
    return data;
}

static const char *compute(const Case *c, float *tangents) {
    if (const char *reason = not_plain(c)) return reason;
    VertexData *vertices = vertices_of(c);
    IndexData *indices = indices_of(c);
    TangentSpaceCalc calculation;
    calculation.setVertexData(vertices);
    calculation.addIndexData(indices);
    calculation.setStoreParityInW(true);
    calculation.setSplitMirrored(true);
    calculation.build(VES_TANGENT, 0, 0);
    const VertexElement *element = vertices->vertexDeclaration->findElementBySemantic(VES_TANGENT);
    HardwareBufferLockGuard rows(vertices->vertexBufferBinding->getBuffer(element->getSource()), HardwareBuffer::HBL_READ_ONLY);
    HardwareBufferLockGuard list(indices->indexBuffer, HardwareBuffer::HBL_READ_ONLY);
    size_t stride = vertices->vertexBufferBinding->getBuffer(element->getSource())->getVertexSize();
    for (size_t corner = 0; corner < c->corners; ++corner) {
        const char *vertex = (const char *)rows.pData + stride * ((const uint32_t *)list.pData)[corner];
        memcpy(tangents + 4 * corner, vertex + element->getOffset(), 16);
        tangents[4 * corner + 3] *= -1.0f; /* OGRE's v points down */
    }
    rows.unlock();
    list.unlock();
    delete indices;
    delete vertices;
    return NULL;
}

int main(int count, char **arguments) {
    LogManager logs;
    logs.createLog("", true, false, true);
    DefaultHardwareBufferManager buffers;
    return run(count, arguments, compute);
}
