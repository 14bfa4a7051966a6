#include "run.h"

#include <osgUtil/TangentSpaceGenerator>

static const char *compute(const Case *c, float *tangents) {
    if (const char *reason = not_plain(c)) return reason;
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(new osg::Vec3Array(c->vertices, (const osg::Vec3 *)c->positions));
    geometry->setNormalArray(new osg::Vec3Array(c->vertices, (const osg::Vec3 *)c->normals), osg::Array::BIND_PER_VERTEX);
    geometry->setTexCoordArray(0, new osg::Vec2Array(c->vertices, (const osg::Vec2 *)c->uvs));
    geometry->addPrimitiveSet(new osg::DrawElementsUInt(osg::PrimitiveSet::TRIANGLES, c->corners, c->indices));
    osg::ref_ptr<osgUtil::TangentSpaceGenerator> generator = new osgUtil::TangentSpaceGenerator;
    generator->generate(geometry.get(), 0);
    for (size_t corner = 0; corner < c->corners; ++corner) {
        size_t vertex = c->indices[corner];
        const float *t = (*generator->getTangentArray())[vertex].ptr();
        float sign = sign_of(c->normals + 3 * vertex, t, (*generator->getBinormalArray())[vertex].ptr());
        const float row[4] = {t[0], t[1], t[2], sign};
        memcpy(tangents + 4 * corner, row, sizeof row);
    }
    return NULL;
}

int main(int count, char **arguments) { return run(count, arguments, compute); }
