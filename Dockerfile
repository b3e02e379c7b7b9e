# docker build -t mmale .
# docker run --rm -v "$PWD/results:/mmale/results" mmale demo
FROM debian:trixie
WORKDIR /mmale
COPY packages.txt .
RUN apt-get update \
  && sed 's/#.*//; s/[[:space:]]//g; /^$/d' packages.txt \
  | DEBIAN_FRONTEND=noninteractive xargs apt-get install -y --no-install-recommends \
  && rm -rf /var/lib/apt/lists/*
COPY . .
RUN ./mmale shell -- true
ENTRYPOINT ["./mmale"]
CMD ["--help"]
