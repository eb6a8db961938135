# The alvor command, with the example scenes. From the project's root: docker build -f docker/client.Dockerfile -t alvor-client .

# The same stage as in server.Dockerfile, so that it is built once.
FROM debian:bookworm-slim AS build
WORKDIR /alvor
COPY scripts/setup.sh scripts/
RUN scripts/setup.sh compile
COPY . .
# What is not needed is removed at once: some gigabytes that the layer would hold.
RUN CMAKE_OPTIONS=-DBUILD_TESTING=OFF scripts/build.sh alvor alvord alvor-import alvor-mpi && \
    cd build/release/bin && strip alvor alvord alvor-import alvor-mpi.so && \
    mkdir /built && cp alvor alvord alvor-import alvor-mpi.so /built && rm -rf /alvor/build

FROM debian:bookworm-slim
RUN apt-get update -qq && \
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
      libassimp5 libcairo2 libembree3-3 libgrpc++1.51 libopenexr-3-1-30 libopenmesh1 libpng16-16 libprotobuf32 libseccomp2 libspdlog1.10 libsqlite3-0 \
      libssl3 libtbb12 libwebp7 libzstd1 && \
    rm -rf /var/lib/apt/lists/* /var/cache/* /var/log/* && \
    echo 'alvor:x:10001:10001::/out:/usr/sbin/nologin' >> /etc/passwd && echo 'alvor:x:10001:' >> /etc/group && \
    install -d -o 10001 -g 10001 /out
COPY scenes /usr/local/share/alvor/scenes
COPY --from=build /built/alvor /built/alvor-import /usr/local/bin/
RUN alvor --version > /dev/null && alvor explain /usr/local/share/alvor/scenes/cornell_box.obj > /dev/null

USER 10001:10001
WORKDIR /out
ENTRYPOINT ["alvor"]
